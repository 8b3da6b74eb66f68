#include "io/plain/array_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// "a, b, c"; of many names the first ones.
std::string list_of(std::vector<std::string> names) {
  constexpr std::size_t kMostNames = 20;
  const bool is_long = names.size() > kMostNames;
  if (is_long) names.resize(kMostNames);
  return fmt::format("{}{}", fmt::join(names, ", "), is_long ? ", ..." : "");
}

}  // namespace

void ArrayNames::add(std::string name, std::size_t dimensions) {
  arrays_.push_back({std::move(name), dimensions});
}

void ArrayNames::refuse(const std::string& name, std::string why) {
  refused_.emplace(name, std::move(why));
}

std::size_t ArrayNames::array_of_frames(const std::string& name) const {
  if (!name.empty()) return require(name);
  for (const bool is_deep : {true, false}) {
    std::size_t found = 0;
    std::vector<std::string> names;
    for (std::size_t index = 0; index < arrays_.size(); ++index) {
      const std::size_t dimensions = arrays_[index].dimensions;
      if (is_deep ? dimensions < 3 : dimensions != 2) continue;
      found = index;
      names.push_back(arrays_[index].name);
    }
    if (names.size() == 1) return found;
    if (names.empty()) continue;
    throw Error(path_.string(), fmt::format("holds several arrays: {}", list_of(names)),
                "choose the readings with --dataset NAME");
  }
  std::vector<std::string> reasons;
  for (const auto& [refused, why] : refused_) reasons.push_back(why);
  throw Error(path_.string(),
              reasons.empty() ? "holds no array of frames"
                              : fmt::format("holds no array of frames: {}", list_of(reasons)),
              "save an array of the shape (frames, rows, columns)");
}

std::optional<std::size_t> ArrayNames::array_of_times(const std::string& name) const {
  return name.empty() ? find("time") : require(name);
}

std::optional<std::size_t> ArrayNames::find(const std::string& name) const {
  const auto found = std::ranges::find(arrays_, name, &NamedArray::name);
  if (found == arrays_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - arrays_.begin());
}

std::size_t ArrayNames::require(const std::string& name) const {
  if (const auto found = find(name)) return *found;
  if (const auto found = refused_.find(name); found != refused_.end()) {
    throw Error(path_.string(), found->second);
  }
  std::vector<std::string> names;
  for (const NamedArray& array : arrays_) names.push_back(array.name);
  throw Error(
      path_.string(), fmt::format("has no array '{:.60}'", name),
      names.empty() ? "it has no array of numbers" : fmt::format("it has {}", list_of(names)));
}

}  // namespace pillarfield
