#include "base/number_text.h"

#include <fmt/format.h>

#include <cmath>

namespace pillarfield {

std::string json_number(double number) {
  if (!std::isfinite(number)) return "null";
  std::string text = fmt::format("{}", number);
  const bool is_whole = text.find_first_of(".e") == std::string::npos;
  return is_whole ? text + ".0" : text;
}

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

std::string counted(std::uint64_t number, const char* noun) {
  return fmt::format("{} {}{}", grouped(number), noun, number == 1 ? "" : "s");
}

std::string rounded(double number) {
  constexpr double kFiveDigits = 1e4;
  constexpr double kWhole = 1e15;
  const double size = std::abs(number);
  if (!(size >= kFiveDigits && size < kWhole)) return fmt::format("{:.5g}", number);
  const auto whole = static_cast<std::uint64_t>(std::llround(size));
  return (number < 0 ? "-" : "") + grouped(whole);
}

std::string fixed(double number, int decimals) {
  const double power = std::pow(10.0, decimals);
  return fmt::format("{:.{}f}", std::round(number * power) / power + 0.0, decimals);
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
  if (part == 0 || whole == 0) return "0 %";
  const double value = 100 * static_cast<double>(part) / static_cast<double>(whole);
  return value < 0.05 ? "<0.1 %" : fmt::format("{:.1f} %", value);
}

}  // namespace pillarfield
