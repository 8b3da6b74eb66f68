#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene_limits.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

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
