#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace steerstat::bench {

/// The functions of the running program.
class Symbols {
 public:
  /// @throws RunFailure where the program's own file cannot be read
  Symbols();

  /// The demangled name of the function at an address; "shared libraries" outside the program.
  [[nodiscard]] std::string name_at(std::uintptr_t address) const;

 private:
  struct Function {
    std::uintptr_t begin, end;
    std::string mangled;
  };
  std::vector<Function> functions_;  // ascending
};

}  // namespace steerstat::bench
