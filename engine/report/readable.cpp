#include "report/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace steerstat {

std::string readable_count(std::uint64_t count) {
  std::string digits = fmt::format("{}", count);
  for (std::size_t from_end = 3; from_end < digits.size(); from_end += 4)
    digits.insert(digits.size() - from_end, 1, ',');
  return digits;
}

std::string counted(std::uint64_t count, const char* noun) {
  return fmt::format("{} {}{}", readable_count(count), noun, count == 1 ? "" : "s");
}

std::string readable_share(double share, std::uint64_t trials) {
  const int digits = static_cast<int>(fmt::formatted_size("{}", trials));
  const int decimals = std::clamp(digits - 2, 1, 9);  // one trial is more than one unit of the last
  return fmt::format("{:.{}f} %", 100.0 * share, decimals);
}

std::string readable_shares(double low, double high, std::uint64_t trials) {
  const std::string first = readable_share(low, trials);
  return fmt::format("{} to {}", first.substr(0, first.size() - 2), readable_share(high, trials));
}

std::string readable_duration(double seconds) {
  if (seconds <= 0.999) return fmt::format("{:.0f} ms", std::ceil(1000.0 * seconds));
  if (seconds < 119.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  const std::uint64_t minutes = (whole + 30) / 60;
  return fmt::format("{} h {:02} min", readable_count(minutes / 60), minutes % 60);
}

std::string readable_rate(double per_second) {
  if (per_second < 0.995) return fmt::format("{:.2f}", per_second);
  if (per_second < 99.95) return fmt::format("{:.1f}", per_second);
  const double unit = std::pow(10.0, std::max(0.0, std::floor(std::log10(per_second)) - 2.0));
  return readable_count(static_cast<std::uint64_t>(std::round(per_second / unit) * unit));
}

std::string interval_bar(double low, double high, int width) {
  const auto columns = [&](double share) { return static_cast<int>(std::lround(share * width)); };
  const int full = columns(low);
  const int shaded = columns(high) - full;
  std::string bar;
  for (int i = 0; i < full; ++i) bar += "█";
  for (int i = 0; i < shaded; ++i) bar += "▒";
  for (int i = full + shaded; i < width; ++i) bar += "·";
  return bar;
}

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c0 = byte < 0x20 || byte == 0x7f;
    const bool c1 = byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
    if (c1) ++i;
    if (c0 || c1) {
      result += "\xEF\xBF\xBD";
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace steerstat
