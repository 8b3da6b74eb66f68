#include "cli/options/argument_group.h"

#include <charconv>
#include <cmath>

#include "base/nearest_word.h"

namespace pillarfield::cli {

CLI::Validator number_in(double least, double most) {
  const auto error_of = [=](const std::string& text) -> std::string {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    if (is_number && value >= least && value <= most) return {};
    if (most == kAny) return fmt::format("'{}' is not a number", text);
    return fmt::format("'{}' is not a number from {:g} to {:g}", text, least, most);
  };
  return {error_of, ""};
}

CLI::Validator whole_number_in(std::uint64_t least, std::uint64_t most) {
  const auto error_of = [=](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    const bool octal = text.size() > 1 && text.front() == '0';
    const bool is_number = parsed.ec == std::errc{} && parsed.ptr == end && !octal;
    if (is_number && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  return {error_of, ""};
}

CLI::Validator one_of(const std::vector<std::string>& words, const std::string& hidden) {
  const auto error_of = [=](const std::string& text) -> std::string {
    if (text == hidden || std::ranges::find(words, text) != words.end()) return {};
    return fmt::format("'{}' is not one of {}{}", text, fmt::join(words, ", "),
                       suggestion(text, words));
  };
  return {error_of, ""};
}

CLI::Validator no_stream() {
  const auto error_of = [](const std::string& text) -> std::string {
    return text == "-"
               ? "'-' is not a file; 'pillarfield stream -' reads frames from standard input, "
                 "and ./- is a file of this name"
               : "";
  };
  return {error_of, ""};
}

}  // namespace pillarfield::cli
