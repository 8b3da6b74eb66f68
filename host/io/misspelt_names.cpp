#include "io/misspelt_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/nearest_word.h"
#include "io/hdf5/file.h"
#include "io/recording_format.h"
#include "skin/effect_parameters.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostNamesTried = 200;

using Names = std::vector<std::string>;

bool add_name(void* names, const char* name) {
  auto& list = *static_cast<Names*>(names);
  list.emplace_back(name);
  return list.size() < kMostNamesTried;
}

Names attributes_of(const hdf5::Handle& group) {
  Names names;
  H5Aiterate2(
      group.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* found) -> herr_t {
        return add_name(found, name) ? 0 : 1;
      },
      &names);
  return names;
}

Names links_of(const hdf5::Handle& group) {
  Names names;
  H5Literate(
      group.get(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* found) -> herr_t {
        return add_name(found, name) ? 0 : 1;
      },
      &names);
  return names;
}

/// The absent known name that a name resembles; empty if none.
std::string meant_by(const std::string& name, const Names& present, const Names& known) {
  constexpr std::size_t kLeastPart = 5;
  if (std::ranges::find(known, name) != known.end()) return {};
  Names absent;
  for (const std::string& each : known) {
    if (std::ranges::find(present, each) == present.end()) absent.push_back(each);
  }
  const auto has_part = [&](const std::string& each) {
    return name.size() >= kLeastPart && each.find(name) != std::string::npos;
  };
  const auto found = std::ranges::find_if(absent, has_part);
  return found != absent.end() ? *found : nearest_word(name, absent, 1 + name.size() / 8);
}

/// A group of recordings, and the names that readers know in it.
struct KnownGroup {
  const char* path;
  Names attributes;
  Names links;
};

std::vector<KnownGroup> known_groups() {
  namespace format = recording_format;
  return {
      {"/", {"format", "version"}, {"frames", "skin", "calibration", "truth", "surface"}},
      {format::kFrames, {}, {"raw", "time", "missing"}},
      {format::kSkin,
       {format::kPitch, format::kCountsPerNewton, format::kThreshold, format::kFullScale,
        format::kExponent, format::kReference},
       {}},
      {format::kCalibration,
       {},
       {"tare", "gain", "dead_zone", "mask", "noise", "bend_x", "bend_y", "bend_xy", "effects"}},
      {format::kEffects, effect_parameter_names(), {}}};
}

}  // namespace

std::vector<std::string> misspelt_names(const hdf5::File& file) {
  std::vector<std::string> warnings;
  const auto warn = [&](const Names& present, const Names& known, const auto& place_of) {
    for (const std::string& name : present) {
      const std::string meant = meant_by(name, present, known);
      if (meant.empty()) continue;
      warnings.push_back(fmt::format("{} is ignored; did you mean {}?", place_of(name), meant));
    }
  };
  for (const KnownGroup& group : known_groups()) {
    const bool is_root = std::string_view(group.path) == "/";
    if (!is_root && !hdf5::exists(file, group.path)) continue;
    const hdf5::Handle opened =
        hdf5::own(H5Oopen(file.id.get(), group.path, H5P_DEFAULT), file.path, "cannot be opened");
    warn(attributes_of(opened), group.attributes, [&](const std::string& name) {
      return fmt::format("Attribute {} of {}", name, group.path);
    });
    warn(links_of(opened), group.links, [&](const std::string& name) {
      return fmt::format("{}/{}", is_root ? "" : group.path, name);
    });
  }
  return warnings;
}

}  // namespace pillarfield
