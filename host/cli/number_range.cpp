#include "cli/number_range.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

namespace pillarfield::cli {

CLI::Validator number_range(double least, double most) {
  const auto complaint = [=](const std::string& text) -> std::string {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    if (is_number && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a number in [{:g}, {:g}]", text, least, most);
  };
  return {complaint, fmt::format("NUMBER in [{:g}, {:g}]", least, most)};
}

CLI::Validator whole_number_range(std::uint64_t least, std::uint64_t most) {
  const auto complaint = [=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    const bool octal = text.size() > 1 && text.front() == '0';
    const bool is_number = parsed.ec == std::errc{} && parsed.ptr == end && !octal;
    if (is_number && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  return {complaint, fmt::format("WHOLE NUMBER in [{}, {}]", least, most)};
}

}  // namespace pillarfield::cli
