#include "all_rows.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"

namespace steerstat {

void require_all_rows(const StoredStudy& stored, const std::string& file, const std::string& what) {
  if (stored.study.store == Store::all) return;
  throw BadUsage(
      fmt::format("{} was run with \"store\": \"{}\" and {} needs the row of every trial; run the study with "
                  "\"store\": \"all\"",
                  file, store_names[static_cast<std::size_t>(stored.study.store)], what));
}

}  // namespace steerstat
