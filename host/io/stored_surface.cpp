#include "io/stored_surface.h"

#include <fmt/format.h>

#include <string>

#include "io/hdf5/attribute.h"
#include "io/hdf5/links.h"
#include "io/hdf5/plane.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr const char* kSurface = "/surface";
constexpr const char* kHeights = "/surface/heights_mm";
constexpr const char* kShape = "shape";
constexpr const char* kRadius = "radius_mm";
constexpr const char* kAxis = "axis_deg";

SurfaceShape shape_named(const std::string& name, const std::string& place) {
  for (const SurfaceShape shape : {SurfaceShape::plane, SurfaceShape::cylinder,
                                   SurfaceShape::sphere, SurfaceShape::height_map}) {
    if (name == name_of(shape)) return shape;
  }
  throw Error(place, fmt::format("shape is '{:.40}'", name),
              "it must be plane, cylinder, sphere or height_map");
}

}  // namespace

void write_surface(const hdf5::File& file, const Surface& surface, const PillarLayout& pillars) {
  const hdf5::Handle group = hdf5::create_group(file, kSurface);
  hdf5::write_attribute(file, group.get(), kShape, std::string(name_of(surface.shape)));
  if (surface.shape == SurfaceShape::height_map) {
    hdf5::write_plane(file, kHeights, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, pillars.rows, pillars.cols,
                      surface.heights_mm.data());
  } else if (surface.shape != SurfaceShape::plane) {
    hdf5::write_attribute(file, group.get(), kRadius, surface.radius_mm);
    hdf5::write_attribute(file, group.get(), kAxis, surface.axis_deg);
  }
}

std::optional<Surface> read_surface(const hdf5::File& file, const PillarLayout& pillars) {
  if (!hdf5::exists(file, kSurface)) return std::nullopt;
  const std::string place = fmt::format("{}: {}", file.path.string(), kSurface);
  const hdf5::Handle group = hdf5::open_object(file, kSurface);
  Surface surface;
  surface.shape = shape_named(hdf5::read_text(file, group.get(), kShape).value_or(""), place);
  if (surface.shape == SurfaceShape::height_map) {
    surface.heights_mm = hdf5::read_plane(file, kHeights, pillars.rows, pillars.cols);
  } else {
    surface.radius_mm = hdf5::read_number(file, group.get(), kRadius).value_or(surface.radius_mm);
    surface.axis_deg = hdf5::read_number(file, group.get(), kAxis).value_or(surface.axis_deg);
  }
  check(surface, pillars, place);
  return surface;
}

}  // namespace pillarfield
