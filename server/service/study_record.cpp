#include "service/study_record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <span>

#include "core/errors.hpp"
#include "store/whole_file.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

constexpr unsigned format = 1;

Json text_or_null(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json(nullptr);
}

std::optional<std::string> text_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional(value.get<std::string>());
}

std::uint64_t count_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  if (!value.is_number_unsigned()) throw RunFailure(fmt::format("{} is not a count", key));
  return value.get<std::uint64_t>();
}

StudyStatus status_of(const std::string& name) {
  const auto found = std::find(study_status_names.begin(), study_status_names.end(), name);
  if (found == study_status_names.end()) throw RunFailure("its status is none");
  return static_cast<StudyStatus>(found - study_status_names.begin());
}

StudyRecord decoded(const Json& json) {
  if (count_of(json, "format") != format) throw RunFailure(fmt::format("its format is not {}", format));
  StudyRecord record;
  record.status = status_of(json.at("status").get<std::string>());
  record.completed = count_of(json, "completed");
  record.created = json.at("created").get<std::string>();
  record.started = text_of(json, "started");
  record.finished = text_of(json, "finished");
  record.failure = text_of(json, "failure");
  record.summary_seal = text_of(json, "summary_seal");
  record.revision = count_of(json, "revision");
  return record;
}

}  // namespace

void write_record(const std::filesystem::path& path, const StudyRecord& record) {
  const Json json{{"format", format},
                  {"status", name_of(record.status)},
                  {"completed", record.completed},
                  {"created", record.created},
                  {"started", text_or_null(record.started)},
                  {"finished", text_or_null(record.finished)},
                  {"failure", text_or_null(record.failure)},
                  {"summary_seal", text_or_null(record.summary_seal)},
                  {"revision", record.revision}};
  // What went wrong may quote the system's words in any encoding.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  write_whole_file(path, {std::as_bytes(std::span(text))}, {}, Reserve::may_be_used);
}

StudyRecord read_record(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_whole_file(path);
  try {
    const auto* const text = reinterpret_cast<const char*>(bytes.data());
    return decoded(Json::parse(text, text + bytes.size()));
  } catch (const std::exception& problem) {
    throw RunFailure(fmt::format("cannot read {}: {}", path.string(), problem.what()));
  }
}

std::string utc_now() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)),
                     (now - seconds).count());
}

std::uint64_t next_revision(std::uint64_t before) {
  const auto now = std::chrono::floor<std::chrono::microseconds>(std::chrono::system_clock::now());
  return std::max<std::uint64_t>(before + 1, static_cast<std::uint64_t>(now.time_since_epoch().count()));
}

}  // namespace steerstat
