#include "io/stored_skin.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "io/hdf5/stored_frames.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"
#include "skin/effect_parameters.h"

namespace pillarfield {
namespace {

/// A plane of floats: its name in the file and its member.
struct FloatPlane {
  const char* name;
  std::vector<float> Calibration::*member;
};
constexpr FloatPlane kFloatPlanes[] = {{recording_format::kTare, &Calibration::tare},
                                       {recording_format::kGain, &Calibration::gain},
                                       {recording_format::kDeadZone, &Calibration::dead_zone},
                                       {recording_format::kNoise, &Calibration::noise},
                                       {recording_format::kBendX, &Calibration::bend_x},
                                       {recording_format::kBendY, &Calibration::bend_y},
                                       {recording_format::kBendXy, &Calibration::bend_xy}};

std::optional<PowerLaw> read_power_law(const hdf5::File& file, hid_t skin) {
  const auto exponent = hdf5::read_number(file, skin, recording_format::kExponent);
  const auto reference_counts = hdf5::read_number(file, skin, recording_format::kReference);
  if (!exponent && !reference_counts) return std::nullopt;
  if (!exponent || !reference_counts) {
    throw Error(fmt::format("{}: {}", file.path.string(), recording_format::kSkin),
                fmt::format("has no attribute '{}'",
                            exponent ? recording_format::kReference : recording_format::kExponent),
                "a power law needs both attributes");
  }
  return PowerLaw{*exponent, *reference_counts};
}

std::optional<SkinLayout> read_layout(const hdf5::File& file, hid_t object) {
  const auto name = hdf5::read_text(file, object, recording_format::kLayout);
  if (!name) return std::nullopt;
  if (const auto layout = layout_named(*name)) return layout;
  throw Error(file.path.string(), fmt::format("its layout is '{:.40}'", *name),
              "it must be pillars or sensels");
}

/// Converts a mask, which a file may store in any number type.
std::vector<std::uint8_t> mask_of(const std::vector<float>& plane, const Skin& skin,
                                  const std::string& place) {
  std::vector<std::uint8_t> mask(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    if (plane[i] != kMissing && plane[i] != kGood && plane[i] != kAbsent) {
      throw Error(place,
                  fmt::format("calibration plane 'mask' is {} at row {}, column {}", plane[i],
                              i / skin.cols, i % skin.cols),
                  "it must be 0, 1 or 2");
    }
    mask[i] = static_cast<std::uint8_t>(plane[i]);
  }
  return mask;
}

}  // namespace

void write_effects(const hdf5::File& file, const char* place, const SensorEffects& effects) {
  if (effects.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, place);
  for (const EffectParameter& parameter : parameters_of(effects)) {
    if (parameter.list) {
      hdf5::write_attribute(file, group.get(), parameter.name, parameter.values);
    } else {
      hdf5::write_attribute(file, group.get(), parameter.name, parameter.values.front());
    }
  }
}

SensorEffects read_effects(const hdf5::File& file, const char* place) {
  if (!hdf5::exists(file, place)) return {};
  const hdf5::Handle group = hdf5::open_object(file, place);
  return effects_of(
      [&](const EffectParameter& asked) {
        return hdf5::read_numbers(file, group.get(), asked.name);
      },
      fmt::format("{}: {}", file.path.string(), place));
}

void write_pitch(const hdf5::File& file, hid_t object, const char* name, const Pitch& pitch) {
  if (pitch.is_square()) {
    hdf5::write_attribute(file, object, name, pitch.col_mm);
  } else {
    hdf5::write_attribute(file, object, name, std::vector{pitch.row_mm, pitch.col_mm});
  }
}

std::optional<Pitch> read_pitch(const hdf5::File& file, hid_t object, const char* name) {
  const auto numbers = hdf5::read_numbers(file, object, name);
  if (!numbers) return std::nullopt;
  if (numbers->size() == 1) return Pitch(numbers->front());
  if (numbers->size() == 2) return Pitch(numbers->front(), numbers->back());
  throw Error(file.path.string(), fmt::format("{} has {} numbers", name, numbers->size()),
              "store one, or two: from row to row and from column to column, mm");
}

hdf5::Handle write_skin(const hdf5::File& file, const StoredSkin& skin) {
  hdf5::Handle group = hdf5::create_group(file, recording_format::kSkin);
  const auto write = [&](const char* name, const std::optional<double>& value) {
    if (value) hdf5::write_attribute(file, group.get(), name, *value);
  };
  if (skin.sensel_pitch_mm) {
    write_pitch(file, group.get(), recording_format::kPitch, *skin.sensel_pitch_mm);
  }
  write(recording_format::kCountsPerNewton, skin.counts_per_newton);
  write(recording_format::kThreshold, skin.threshold_counts);
  write(recording_format::kFullScale, skin.full_scale_counts);
  if (skin.power_law) {
    write(recording_format::kExponent, skin.power_law->exponent);
    write(recording_format::kReference, skin.power_law->reference_counts);
  }
  if (skin.layout) {
    hdf5::write_attribute(file, group.get(), recording_format::kLayout,
                          std::string(name_of(*skin.layout)));
  }
  if (skin.falling) hdf5::write_attribute(file, group.get(), recording_format::kFalling, 1);
  return group;
}

hdf5::Handle open_skin(const hdf5::File& file) {
  if (!hdf5::exists(file, recording_format::kSkin)) return {};
  return hdf5::open_object(file, recording_format::kSkin);
}

StoredSkin read_skin(const hdf5::File& file) {
  const hdf5::Handle object = open_skin(file);
  if (!object.valid()) return {};
  const auto read = [&](const char* name) { return hdf5::read_number(file, object.get(), name); };
  return {read_pitch(file, object.get(), recording_format::kPitch),
          read(recording_format::kCountsPerNewton),
          read(recording_format::kThreshold),
          read(recording_format::kFullScale),
          read_power_law(file, object.get()),
          read_layout(file, object.get()),
          read(recording_format::kFalling).value_or(0) != 0};
}

void write_planes(const hdf5::File& file, const Skin& skin, const Calibration& calibration) {
  if (calibration.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, recording_format::kCalibration);
  for (const auto& [name, member] : kFloatPlanes) {
    const std::vector<float>& plane = calibration.*member;
    if (plane.empty()) continue;
    hdf5::write_plane(file, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, skin.rows, skin.cols,
                      plane.data());
  }
  write_effects(file, recording_format::kEffects, calibration.effects);
  if (calibration.mask.empty()) return;
  hdf5::write_plane(file, recording_format::kMask, H5T_STD_U8LE, H5T_NATIVE_UINT8, skin.rows,
                    skin.cols, calibration.mask.data());
}

void rewrite_tare(const hdf5::File& file, const Calibration& calibration, double threshold_counts) {
  hdf5::rewrite_attribute(file, open_skin(file).get(), recording_format::kThreshold,
                          threshold_counts);
  for (const auto& [name, member] : kFloatPlanes) {
    if (member != &Calibration::tare && member != &Calibration::noise) continue;
    const std::vector<float>& plane = calibration.*member;
    if (plane.empty() || !hdf5::exists(file, name)) continue;
    hdf5::rewrite_plane(file, name, H5T_NATIVE_FLOAT, plane.data());
  }
}

Calibration read_planes(const hdf5::File& file, const Skin& skin, std::optional<SenselType> type) {
  const auto plane = [&](const char* name) {
    if (!hdf5::exists(file, name)) return std::vector<float>();
    return hdf5::read_plane(file, name, skin.rows, skin.cols);
  };
  Calibration calibration;
  for (const auto& [name, member] : kFloatPlanes) calibration.*member = plane(name);
  const std::string place =
      fmt::format("{}: {}", file.path.string(), recording_format::kCalibration);
  calibration.effects = read_effects(file, recording_format::kEffects);
  calibration.mask = mask_of(plane(recording_format::kMask), skin, place);
  check(calibration, skin, place, type);
  return calibration;
}

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

void write_surface(const hdf5::File& file, const Surface& surface, const ElementGrid& pillars) {
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

std::optional<Surface> read_surface(const hdf5::File& file, const ElementGrid& pillars) {
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
