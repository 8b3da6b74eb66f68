#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace pillarfield {

/// A value with its name in files and options.
template <class Value>
struct Named {
  const char* name;
  Value value;
};

/// The name of a value of a table.
template <class Value, std::size_t count>
constexpr const char* name_in(const std::array<Named<Value>, count>& table, Value value) {
  return std::ranges::find(table, value, &Named<Value>::value)->name;
}

/// The row of this name; nullptr without one.
template <class Value, std::size_t count>
constexpr const Named<Value>* row_named(const std::array<Named<Value>, count>& table,
                                        std::string_view name) {
  const auto found = std::ranges::find(table, name, &Named<Value>::name);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace pillarfield
