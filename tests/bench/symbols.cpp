#include "symbols.hpp"

#include <cxxabi.h>
#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>

#include "core/errors.hpp"

namespace steerstat::bench {
namespace {

/// A record of the program's file.
template <class Record>
Record record_at(std::span<const char> file, std::uint64_t offset) {
  if (offset + sizeof(Record) > file.size()) throw RunFailure("the program's file is shorter than it says");
  Record record;
  std::memcpy(&record, file.data() + offset, sizeof record);
  return record;
}

std::vector<char> read_program() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  std::vector<char> bytes(std::filesystem::file_size("/proc/self/exe"));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file || bytes.size() < sizeof(Elf64_Ehdr)) throw RunFailure("cannot read /proc/self/exe");
  return bytes;
}

/// Where the program was loaded.
std::uintptr_t load_address() {
  std::uintptr_t address = 0;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* out) {
        *static_cast<std::uintptr_t*>(out) = info->dlpi_addr;
        return 1;  // the program comes first
      },
      &address);
  return address;
}

std::string demangled(const std::string& mangled) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(mangled.substr(0, mangled.find('.')).c_str(), nullptr, nullptr, &status), &std::free);
  return status == 0 ? name.get() : mangled;
}

}  // namespace

Symbols::Symbols() {
  const std::vector<char> bytes = read_program();
  const auto header = record_at<Elf64_Ehdr>(bytes, 0);
  const std::uintptr_t base = load_address();
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    const auto section = record_at<Elf64_Shdr>(bytes, header.e_shoff + i * header.e_shentsize);
    if (section.sh_type != SHT_SYMTAB) continue;
    const auto names =
        record_at<Elf64_Shdr>(bytes, header.e_shoff + section.sh_link * std::uint64_t{header.e_shentsize});
    for (std::uint64_t at = 0; at < section.sh_size; at += sizeof(Elf64_Sym)) {
      const auto symbol = record_at<Elf64_Sym>(bytes, section.sh_offset + at);
      if ((symbol.st_info & 0xf) != STT_FUNC || symbol.st_size == 0) continue;
      const std::uintptr_t begin = base + symbol.st_value;
      functions_.push_back({begin, begin + symbol.st_size, bytes.data() + names.sh_offset + symbol.st_name});
    }
  }
  if (functions_.empty()) throw RunFailure("the program has no symbols; build it without -s");
  std::sort(functions_.begin(), functions_.end(),
            [](const Function& a, const Function& b) { return a.begin < b.begin; });
}

std::string Symbols::name_at(std::uintptr_t address) const {
  auto after = std::upper_bound(functions_.begin(), functions_.end(), address,
                                [](std::uintptr_t x, const Function& f) { return x < f.begin; });
  if (after == functions_.begin()) return "shared libraries";
  const Function& function = *std::prev(after);
  return address < function.end ? demangled(function.mangled) : "shared libraries";
}

}  // namespace steerstat::bench
