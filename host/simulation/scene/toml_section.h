#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstddef>
#include <cstdint>
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

/// Throws Error, "file:line: ...", if a TOML text has a key of more than 16 parts (`a.b.c` has
/// three): toml++ recurses into each part without a bound.
void check_key_depth(std::string_view toml, const std::string& file);

}  // namespace pillarfield
