#include "simulation/scene/toml_depth.h"

#include <fmt/format.h>

#include <algorithm>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostParts = 16;

/// Length in bytes of the string at the start of `text`, quotes included. An unclosed string ends
/// before the line's end; a multi-line one at the end of the text.
std::size_t string_length(std::string_view text) {
  const char quote = text.front();
  const std::string three(3, quote);
  const bool several_lines = text.starts_with(three);
  std::size_t at = several_lines ? 3 : 1;
  for (; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (!several_lines && text[at] == '\n') {
      return at;
    } else if (!several_lines && text[at] == quote) {
      return at + 1;
    } else if (several_lines && text.substr(at).starts_with(three)) {
      at += 3;
      // Up to two quotes may precede the closing three.
      for (int more = 0; more < 2 && at < text.size() && text[at] == quote; ++more) ++at;
      return at;
    }
  }
  return text.size();
}

/// Length in bytes of the token at the start of `text`: a string, a comment, or one character.
std::size_t token_length(std::string_view text) {
  if (text.front() == '"' || text.front() == '\'') return string_length(text);
  if (text.front() == '#') return std::min(text.find('\n'), text.size());
  return 1;
}

}  // namespace

void check_key_depth(std::string_view toml, const std::string& file) {
  constexpr std::string_view kEndsOfKeys = "=,[]{}#\n";
  std::size_t line = 1;
  std::size_t parts = 1;
  while (!toml.empty()) {
    const std::string_view token = toml.substr(0, token_length(toml));
    line += static_cast<std::size_t>(std::ranges::count(token, '\n'));
    if (token == ".") ++parts;
    if (kEndsOfKeys.find(token.front()) != std::string_view::npos) parts = 1;
    if (parts > kMostParts) {
      throw Error(fmt::format("{}:{}", file, line),
                  fmt::format("a key has more than {} parts", kMostParts),
                  "mend the line, or see docs/scenes.md for an example");
    }
    toml.remove_prefix(token.size());
  }
}

}  // namespace pillarfield
