#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene_limits.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

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
  for (const auto& [name, value] : names) {
    if (name == *text) return value;
  }
  section.fail(key, fmt::format("is \"{:.40}\"", *text), quoted(names));
}

}  // namespace pillarfield
