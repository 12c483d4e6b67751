#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Numbers as a person likes to read them. All are pure and thread-safe, whatever the locale.
namespace steerstat {

/// What stands for a number that there is not.
constexpr const char* no_data = "–";

/// "1,234,567"
std::string readable_count(std::uint64_t count);

/// "1 trial", "1,234 trials"
std::string counted(std::uint64_t count, const char* noun);

/// A share as a percentage, "46.85 %", with the digits that tell one trial of `trials`: only 0 reads as nought and only
/// 1 as a hundred.
///
/// @param share  in [0, 1]
std::string readable_share(double share, std::uint64_t trials);

/// Two shares of the same trials as a range, "45.21 to 48.50 %". @param low, high  in [0, 1]
std::string readable_shares(double low, double high, std::uint64_t trials);

/// A duration: "4 ms" (rounded up), "7.4 s", "2 min 05 s", "3 h 20 min". @param seconds  >= 0
std::string readable_duration(double seconds);

/// A rate: "0.42", "8.3", "271", "257,000" (three digits). @param per_second  >= 0
std::string readable_rate(double per_second);

/// A horizontal bar of `width` columns: full blocks up to `low`, shaded ones to `high`, a track behind.
///
/// @param low, high  in [0, 1], low <= high
std::string interval_bar(double low, double high, int width);

/// `text` with control characters replaced by U+FFFD, so that a study's name cannot steer the terminal.
std::string printable(std::string_view text);

}  // namespace steerstat
