#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>

#include "api/byte_range.hpp"
#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "hardening/file_descriptor.hpp"

namespace steerstat {
namespace {

/// An open file: it stays readable when the study is removed meanwhile.
struct OpenFile {
  FileDescriptor descriptor;
  std::uint64_t size{0};
};

OpenFile open_file(const std::filesystem::path& path) {
  OpenFile file{FileDescriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC)), 0};
  struct stat status {};
  if (file.descriptor.get() < 0 || fstat(file.descriptor.get(), &status) != 0) {
    throw RunFailure("the result file cannot be read; the service's disk may be damaged");
  }
  file.size = static_cast<std::uint64_t>(status.st_size);
  return file;
}

/// Sends the next piece. @param offset  in the file
bool send_piece(int descriptor, std::size_t offset, std::size_t left, httplib::DataSink& sink) {
  std::array<char, 65536> buffer;
  const ssize_t count = pread(descriptor, buffer.data(), std::min(left, buffer.size()), static_cast<off_t>(offset));
  if (count < 0 && errno == EINTR) return true;
  return count > 0 && sink.write(buffer.data(), static_cast<std::size_t>(count));
}

/// The bytes to send, with the headers that say which; nothing where those asked for do not exist.
std::optional<ByteRange> choose_range(const httplib::Request& request, httplib::Response& response,
                                      const std::string& tag, std::uint64_t size) {
  const ByteRange whole{0, size};
  const std::string range = request.get_header_value("x-single-range");  // Range, as the door hands it on
  const std::string condition = request.get_header_value("If-Range");
  if (range.empty() || (!condition.empty() && condition != tag)) return whole;
  const std::optional<ByteRange> asked = single_range(range, size);
  if (!asked) return whole;
  if (asked->size == 0) return std::nullopt;
  response.status = 206;
  response.set_header("Content-Range",
                      fmt::format("bytes {}-{}/{}", asked->begin, asked->begin + asked->size - 1, size));
  return asked;
}

void download(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const StudyState state = state_of(surroundings.service, id);
  const std::optional<std::filesystem::path> path = surroundings.service.result_file(id);
  if (!path) {
    throw Refused({409,
                   "the study has no result file yet: it is " + std::string(name_of(state.status)),
                   {},
                   {{"Retry-After", "5"}}});
  }
  const std::string tag = tag_of(state.revision);
  if (has_already(call.request, response, tag)) return;
  const auto place = take_place(surroundings.downloads, "downloads");
  const auto file = std::make_shared<OpenFile>(open_file(*path));
  const std::optional<ByteRange> range = choose_range(call.request, response, tag, file->size);
  if (!range) {
    throw Refused({416,
                   fmt::format("the result file has {} bytes", file->size),
                   {},
                   {{"Content-Range", fmt::format("bytes */{}", file->size)}}});
  }
  response.set_header("ETag", tag);
  response.set_header("Accept-Ranges", "bytes");
  response.set_header("Cache-Control", "no-cache");
  response.set_header("Content-Disposition", fmt::format("attachment; filename=\"{}.h5\"", id));
  response.set_content_provider(
      range->size, "application/x-hdf5",
      [file, place, begin = range->begin](std::size_t offset, std::size_t left, httplib::DataSink& sink) {
        return send_piece(file->descriptor.get(), begin + offset, left, sink);
      });
}

}  // namespace

void add_result_route(Router& router, Surroundings& surroundings) {
  router.add("GET", "/v1/studies/{id}/results.h5",
             [&](const Call& call, auto& response) { download(surroundings, call, response); });
}

}  // namespace steerstat
