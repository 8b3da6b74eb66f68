#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene_limits.h"

namespace pillarfield {

/// A table of a TOML file, read key by key. Readers return nullopt for an absent key and throw
/// Error, "file:line: key 'x' in [section] ...; allowed: ...", for a value that is not allowed.
/// Allowed keys are those that have been read: finish() refuses all others.
class TomlSection {
 public:
  /// `title` is the section's name in messages: "[skin]". Without a `table`, it is absent. `file`
  /// and `table` must outlive the section.
  TomlSection(const toml::table* table, std::string title, const std::string& file)
      : table_(table), title_(std::move(title)), file_(&file) {}

  [[nodiscard]] bool is_present() const { return table_ != nullptr; }
  [[nodiscard]] bool has(std::string_view key) const;

  std::optional<double> number(std::string_view key, const Range& range);
  std::optional<std::int64_t> whole_number(std::string_view key, std::int64_t low,
                                           std::int64_t high);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);

  /// A list of `count` numbers; of at least one if `count` is zero.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                             const Range& range);
  /// A list of pairs of numbers.
  std::optional<std::vector<std::array<double, 2>>> pairs(std::string_view key, const Range& range);
  [[nodiscard]] bool is_list(std::string_view key) const;
  /// A list of at least one table.
  std::optional<std::vector<TomlSection>> tables(std::string_view key, const std::string& title);

  /// The table `key`, with the title "[key]".
  TomlSection table(std::string_view key);

  /// Refuses keys that have not been read.
  void finish() const;

  /// Throws Error: what the key `is`, and what is allowed.
  [[noreturn]] void fail(std::string_view key, std::string_view is, std::string_view allowed) const;
  /// Refuses a key that does not apply to `kind`.
  void refuse(std::string_view key, const std::string& kind) const;
  [[noreturn]] void fail_missing(std::string_view key, std::string_view allowed) const;

 private:
  const toml::node* find(std::string_view key);
  [[nodiscard]] toml::source_region source() const;
  [[noreturn]] void fail_at(const toml::source_region& source, std::string_view key,
                            std::string_view is, std::string_view allowed) const;

  const toml::table* table_;
  std::string title_;
  const std::string* file_;
  std::vector<std::string_view> read_keys_;
};

/// Reads the numbers that apply to a contact or an indenter, the `kind`; refuses others.
template <class Part, std::size_t count>
void read_part(TomlSection& section, const std::array<PartQuantity<Part>, count>& quantities,
               const std::string& kind, Part& part) {
  for (const auto& [quantity, required, applies] : quantities) {
    if (!applies(part)) {
      section.refuse(quantity.key, kind);
      continue;
    }
    const auto value = section.number(quantity.key, quantity.range);
    if (!value && required) section.fail_missing(quantity.key, quantity.range.text());
    if (value) part.*quantity.member = *value;
  }
}

/// Throws Error, "file:line: ...", if a TOML text has a key of more than 16 parts (`a.b.c` has
/// three): toml++ recurses into each part without a bound.
void check_key_depth(std::string_view toml, const std::string& file);

/// Names as in messages: "sphere", "flat_punch", ...
template <class Names>
std::string quoted(const Names& names) {
  std::vector<std::string> all;
  all.reserve(names.size());
  for (const auto& name : names) all.push_back(fmt::format("\"{}\"", name.name));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The value of a name; unset if the key is absent.
template <class Value, std::size_t count>
std::optional<Value> read_name(TomlSection& section, std::string_view key,
                               const std::array<Named<Value>, count>& names) {
  const std::optional<std::string> text = section.text(key);
  if (!text) return std::nullopt;
  if (const Named<Value>* const row = row_named(names, *text)) return row->value;
  section.fail(key, fmt::format("is \"{:.40}\"", *text), quoted(names));
}

/// Reads the path of a contact or indenter: the tables of `path` by `read`, with increasing time_s;
/// or a single key from the section itself, whose names exclude `path`. Throws Error with the line.
template <class Key, class Read>
std::vector<Key> read_path(TomlSection& section, const std::string& title,
                           std::initializer_list<std::string_view> names, const Read& read) {
  auto tables = section.tables("path", title);
  if (!tables) return {read(section)};
  for (const std::string_view name : names) {
    if (section.has(name)) section.fail(name, "comes with path", "one of the two");
  }
  std::vector<Key> path;
  for (TomlSection& table : *tables) {
    const auto time = table.number("time_s", kPathTimeS);
    if (!time) table.fail_missing("time_s", kPathTimeS.text());
    if (!path.empty() && *time <= path.back().time_s) {
      table.fail("time_s", fmt::format("is {}", *time),
                 fmt::format("more than that of the key before, {}", path.back().time_s));
    }
    path.push_back(read(table));
    path.back().time_s = *time;
    table.finish();
  }
  return path;
}

}  // namespace pillarfield
