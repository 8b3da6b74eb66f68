#include "pillarfield/printable.h"

#include <fmt/format.h>

#include "base/utf8.h"

namespace pillarfield {
namespace {

/// True if a character controls the terminal or the line.
bool is_command(char32_t point) {
  const auto between = [point](char32_t first, char32_t last) {
    return point >= first && point <= last;
  };
  return point < 0x20 || between(0x7f, 0x9f) || between(0x200e, 0x200f) ||
         between(0x2028, 0x202e) || between(0x2066, 0x2069);
}

std::string escaped(char32_t point) {
  if (point == '\n') return "\\n";
  if (point == '\r') return "\\r";
  if (point == '\t') return "\\t";
  return fmt::format("\\u{:04x}", static_cast<std::uint32_t>(point));
}

}  // namespace

std::string printable(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      line += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
      text.remove_prefix(1);
      continue;
    }
    const std::string_view character = text.substr(0, length);
    const char32_t point = code_point(character);
    line += is_command(point) ? escaped(point) : std::string(character);
    text.remove_prefix(length);
  }
  return line;
}

}  // namespace pillarfield
