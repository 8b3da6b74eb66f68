#include "simulation/scene/toml_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A value as in messages.
std::string describe(const toml::node& node) {
  if (const auto* number = node.as_integer()) return fmt::format("is {}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("is {}", number->get());
  if (const auto* flag = node.as_boolean()) return fmt::format("is {}", flag->get());
  if (const auto* text = node.as_string()) return fmt::format("is \"{:.40}\"", text->get());
  if (const auto* array = node.as_array()) return fmt::format("is a list of {}", array->size());
  return node.is_table() ? "is a table" : "is a date or time";
}

/// The number in a node; unset if it is not a number or out of range.
std::optional<double> number_in(const toml::node& node, const Range& range) {
  if (!node.is_number()) return std::nullopt;
  const std::optional<double> value = node.value<double>();
  return value && range.contains(*value) ? value : std::nullopt;
}

}  // namespace

bool TomlSection::has(std::string_view key) const { return table_ && table_->contains(key); }

std::optional<double> TomlSection::number(std::string_view key, const Range& range) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const std::optional<double> value = number_in(*node, range);
  if (!value) fail_at(node->source(), key, describe(*node), range.text());
  return value;
}

std::optional<std::int64_t> TomlSection::whole_number(std::string_view key, std::int64_t low,
                                                      std::int64_t high) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const auto* value = node->as_integer();
  if (value && value->get() >= low && value->get() <= high) return value->get();
  fail_at(node->source(), key, describe(*node),
          fmt::format("a whole number from {} to {}", low, high));
}

std::optional<bool> TomlSection::flag(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (const auto* value = node->as_boolean()) return value->get();
  fail_at(node->source(), key, describe(*node), "true or false");
}

std::optional<std::string> TomlSection::text(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (const auto* value = node->as_string()) return value->get();
  fail_at(node->source(), key, describe(*node), "a text in quotes");
}

std::optional<std::vector<double>> TomlSection::numbers(std::string_view key, std::size_t count,
                                                        const Range& range) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const std::string allowed = count == 0
                                  ? fmt::format("a list, each {}", range.text())
                                  : fmt::format("a list of {}, each {}", count, range.text());
  const toml::array* array = node->as_array();
  if (!array || array->empty() || (count != 0 && array->size() != count)) {
    fail_at(node->source(), key, describe(*node), allowed);
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const std::optional<double> value = number_in(element, range);
    if (!value) fail_at(element.source(), key, "has an element that " + describe(element), allowed);
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<std::array<double, 2>>> TomlSection::pairs(std::string_view key,
                                                                     const Range& range) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const std::string allowed = fmt::format("a list of pairs, each {}", range.text());
  const toml::array* array = node->as_array();
  if (!array || array->empty()) fail_at(node->source(), key, describe(*node), allowed);
  std::vector<std::array<double, 2>> values;
  for (const toml::node& element : *array) {
    const toml::array* pair = element.as_array();
    const bool is_pair = pair && pair->size() == 2;
    const auto first = is_pair ? number_in(*pair->get(0), range) : std::nullopt;
    const auto second = is_pair ? number_in(*pair->get(1), range) : std::nullopt;
    if (!first || !second) {
      fail_at(element.source(), key, "has an element that is not such a pair", allowed);
    }
    values.push_back({*first, *second});
  }
  return values;
}

bool TomlSection::is_list(std::string_view key) const {
  const toml::node* node = table_ ? table_->get(key) : nullptr;
  return node && node->is_array();
}

std::optional<std::vector<TomlSection>> TomlSection::tables(std::string_view key,
                                                            const std::string& title) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const std::string allowed = fmt::format("a list of tables, {}", title);
  const toml::array* array = node->as_array();
  if (!array) fail_at(node->source(), key, describe(*node), allowed);
  if (array->empty()) return std::nullopt;
  std::vector<TomlSection> sections;
  for (const toml::node& element : *array) {
    if (!element.is_table()) {
      fail_at(element.source(), key, "has an element that " + describe(element), allowed);
    }
    sections.emplace_back(element.as_table(), title, *file_);
  }
  return sections;
}

TomlSection TomlSection::table(std::string_view key) {
  const std::string title = fmt::format("[{}]", key);
  const toml::node* node = find(key);
  if (node && !node->is_table()) {
    fail_at(node->source(), key, describe(*node), "a table, " + title);
  }
  return {node ? node->as_table() : nullptr, title, *file_};
}

void TomlSection::finish() const {
  if (!table_) return;
  for (const auto& [key, node] : *table_) {
    if (std::find(read_keys_.begin(), read_keys_.end(), key.str()) != read_keys_.end()) continue;
    fail_at(key.source(), key.str(), "is unknown here",
            fmt::format("{}", fmt::join(read_keys_, ", ")));
  }
}

void TomlSection::fail(std::string_view key, std::string_view is, std::string_view allowed) const {
  const toml::node* node = table_ ? table_->get(key) : nullptr;
  fail_at(node ? node->source() : source(), key, is, allowed);
}

void TomlSection::refuse(std::string_view key, const std::string& kind) const {
  if (has(key)) fail(key, "does not apply to " + kind, "no such key");
}

void TomlSection::fail_missing(std::string_view key, std::string_view allowed) const {
  fail_at(source(), key, "is missing", allowed);
}

const toml::node* TomlSection::find(std::string_view key) {
  read_keys_.push_back(key);
  return table_ ? table_->get(key) : nullptr;
}

toml::source_region TomlSection::source() const {
  return table_ ? table_->source() : toml::source_region{};
}

void TomlSection::fail_at(const toml::source_region& source, std::string_view key,
                          std::string_view is, std::string_view allowed) const {
  // An absent section has no line.
  const std::string place =
      source.begin.line == 0 ? *file_ : fmt::format("{}:{}", *file_, source.begin.line);
  throw Error(place, fmt::format("key '{:.40}' in {} {}", key, title_, is),
              fmt::format("allowed: {}", allowed));
}

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
