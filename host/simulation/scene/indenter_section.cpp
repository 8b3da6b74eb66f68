#include <fmt/format.h>

#include <algorithm>

#include "simulation/scene/scene_limits.h"
#include "simulation/scene/scene_sections.h"

namespace pillarfield {
namespace {

std::string shape_text(IndenterShape shape) {
  return fmt::format(R"(shape = "{}")", kIndenterShapes[static_cast<std::size_t>(shape)].name);
}

/// Reads a list of `values`' length.
template <std::size_t count>
void read_sizes(TomlSection& section, std::string_view key, std::array<double, count>& values) {
  const auto sizes = section.numbers(key, count, kIndenterSizeMm);
  if (!sizes) {
    section.fail_missing(key, fmt::format("a list of {}, each {}", count, kIndenterSizeMm.text()));
  }
  std::copy_n(sizes->begin(), count, values.begin());
}

void read_height_map_keys(TomlSection& section, const std::filesystem::path& folder,
                          Indenter& indenter) {
  indenter.height_map = read_height_map_path(section, folder);
  read_sizes(section, "height_map_size_mm", indenter.height_map_size_mm);
}

void read_indenter_shape(TomlSection& section, const std::filesystem::path& folder,
                         Indenter& indenter) {
  const auto shape = read_name(section, "shape", kIndenterShapes);
  if (!shape) section.fail_missing("shape", quoted(kIndenterShapes));
  indenter.shape = *shape;
  if (indenter.shape == IndenterShape::ellipsoid) {
    read_sizes(section, "radii_mm", indenter.radii_mm);
  } else {
    section.refuse("radii_mm", shape_text(indenter.shape));
  }
  if (indenter.shape == IndenterShape::height_map) {
    read_height_map_keys(section, folder, indenter);
  } else {
    section.refuse("height_map", shape_text(indenter.shape));
    section.refuse("height_map_size_mm", shape_text(indenter.shape));
  }
}

/// Refuses a key without the key that it depends on.
void expect_together(const TomlSection& section, std::string_view key, std::string_view needed) {
  if (!section.has(key) || section.has(needed)) return;
  section.fail(key, fmt::format("comes without {}", needed), "both, or none");
}

/// Reads a key of the path, or the pose of an indenter in a fixed place.
IndenterKey read_indenter_key(TomlSection& section) {
  const auto position = section.numbers("position_mm", 2, kPathPositionMm);
  if (!position) section.fail_missing("position_mm", "a list of 2, [x, y] in millimetres");
  const auto angle = section.number("angle_deg", kPathAngleDeg);
  const auto load = section.number("load_n", kPathLoadN);
  if (!load) section.fail_missing("load_n", kPathLoadN.text());
  return {0, position->front(), position->back(), angle.value_or(0), *load};
}

}  // namespace

std::filesystem::path read_height_map_path(TomlSection& section,
                                           const std::filesystem::path& folder) {
  constexpr std::string_view kAllowed = "the path of a .npy file, from the scene's folder";
  const auto path = section.text("height_map");
  if (!path) section.fail_missing("height_map", kAllowed);
  if (!path->ends_with(".npy")) {
    section.fail("height_map", fmt::format("is \"{:.40}\"", *path), kAllowed);
  }
  return folder / *path;
}

Indenter read_indenter(TomlSection& section, const std::filesystem::path& folder,
                       SkinLayout layout) {
  Indenter indenter;
  read_indenter_shape(section, folder, indenter);
  read_part(section, kIndenterQuantities, shape_text(indenter.shape), indenter);
  if (layout == SkinLayout::pillars && !section.has("friction")) {
    section.fail_missing("friction", kIndenterFriction.text());
  }
  expect_together(section, "roughness_exponent", "roughness_um");
  expect_together(section, "roughness_length_mm", "roughness_um");
  expect_together(section, "friction_variation_length_mm", "friction_variation");
  if (const auto substeps = section.whole_number("substeps", 1, kMaxSubsteps)) {
    indenter.substeps = static_cast<std::uint32_t>(*substeps);
  }
  indenter.path = read_path<IndenterKey>(section, "path of [[indenter]]",
                                         {"position_mm", "angle_deg", "load_n"}, read_indenter_key);
  section.finish();
  return indenter;
}

}  // namespace pillarfield
