#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene_limits.h"

namespace pillarfield {

/// A table of a TOML file that is read key by key. Every reader returns nothing where the key is
/// absent and throws Error, "file:line: key 'x' in [section] ...; allowed: ...", where its value is
/// not allowed. The keys asked for are the keys allowed: finish() refuses all others.
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

  /// A list of numbers: `count` of them, or any number but none where `count` is zero.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                             const Range& range);
  /// A list of tables, one at least.
  std::optional<std::vector<TomlSection>> tables(std::string_view key, const std::string& title);

  /// The table of that name, titled by it.
  TomlSection table(std::string_view key);

  /// Refuses the keys that nothing has asked for.
  void finish() const;

  /// Throws: the key `is` something that it may not be.
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
  std::vector<std::string_view> asked_;
};

}  // namespace pillarfield
