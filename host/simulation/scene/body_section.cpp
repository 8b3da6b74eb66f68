#include "simulation/scene/body_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "simulation/scene/named_value.h"
#include "simulation/scene/path_section.h"
#include "simulation/scene/scene_limits.h"

namespace pillarfield {
namespace {

std::string shape_text(BodyShape shape) {
  return fmt::format(R"(shape = "{}")", kBodyShapes[static_cast<std::size_t>(shape)].name);
}

/// Refuses a key that does not apply to the shape.
void refuse_key(const TomlSection& section, std::string_view key, BodyShape shape) {
  if (section.has(key)) section.fail(key, "does not apply to " + shape_text(shape), "no such key");
}

/// Reads the numbers that apply to the shape; refuses others.
void read_body_quantities(TomlSection& section, Body& body) {
  for (const auto& [quantity, required, applies] : kBodyQuantities) {
    if (!applies(body.shape)) {
      refuse_key(section, quantity.key, body.shape);
      continue;
    }
    const auto value = section.number(quantity.key, quantity.range);
    if (!value && required) section.fail_missing(quantity.key, quantity.range.text());
    if (value) body.*quantity.member = *value;
  }
}

/// Reads a list of `values`' length.
template <std::size_t count>
void read_sizes(TomlSection& section, std::string_view key, std::array<double, count>& values) {
  const auto sizes = section.numbers(key, count, kBodySizeMm);
  if (!sizes) {
    section.fail_missing(key, fmt::format("a list of {}, each {}", count, kBodySizeMm.text()));
  }
  std::copy_n(sizes->begin(), count, values.begin());
}

void read_height_map_keys(TomlSection& section, const std::filesystem::path& folder, Body& body) {
  body.height_map = read_height_map_path(section, folder);
  read_sizes(section, "height_map_size_mm", body.height_map_size_mm);
}

void read_body_shape(TomlSection& section, const std::filesystem::path& folder, Body& body) {
  const auto shape = read_name(section, "shape", kBodyShapes);
  if (!shape) section.fail_missing("shape", quoted(kBodyShapes));
  body.shape = *shape;
  if (body.shape == BodyShape::ellipsoid) {
    read_sizes(section, "radii_mm", body.radii_mm);
  } else {
    refuse_key(section, "radii_mm", body.shape);
  }
  if (body.shape == BodyShape::height_map) {
    read_height_map_keys(section, folder, body);
  } else {
    refuse_key(section, "height_map", body.shape);
    refuse_key(section, "height_map_size_mm", body.shape);
  }
}

/// Refuses a key without the key that it depends on.
void expect_together(const TomlSection& section, std::string_view key, std::string_view needed) {
  if (!section.has(key) || section.has(needed)) return;
  section.fail(key, fmt::format("comes without {}", needed), "both, or none");
}

/// Reads a key of the path, or the pose of a body in a fixed place.
BodyKey read_body_key(TomlSection& section) {
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
  constexpr std::string_view kAllowed = "the path of a .npy or .png file, from the scene's folder";
  const auto path = section.text("height_map");
  if (!path) section.fail_missing("height_map", kAllowed);
  if (!path->ends_with(".npy") && !path->ends_with(".png")) {
    section.fail("height_map", fmt::format("is \"{:.40}\"", *path), kAllowed);
  }
  return folder / *path;
}

Body read_body(TomlSection& section, const std::filesystem::path& folder) {
  Body body;
  read_body_shape(section, folder, body);
  read_body_quantities(section, body);
  expect_together(section, "roughness_exponent", "roughness_um");
  expect_together(section, "roughness_length_mm", "roughness_um");
  expect_together(section, "friction_variation_length_mm", "friction_variation");
  if (const auto substeps = section.whole_number("substeps", 1, kMaxSubsteps)) {
    body.substeps = static_cast<std::uint32_t>(*substeps);
  }
  body.path = read_path<BodyKey>(section, "path of [[body]]",
                                 {"position_mm", "angle_deg", "load_n"}, read_body_key);
  section.finish();
  return body;
}

}  // namespace pillarfield
