#include "io/stored_skin.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "io/hdf5/stored_frames.h"
#include "pillarfield/error.h"
#include "skin/effect_parameters.h"
#include "skin/skin_fields.h"

namespace pillarfield {
namespace {

constexpr const char* kPitch = "sensel_pitch_mm";
constexpr const char* kLayout = "layout";
constexpr const char* kFalling = "falling";  ///< 1: readings are mirrored
constexpr const char* kCalibration = "/calibration";
constexpr const char* kEffects = "/calibration/effects";

std::string path_of(const PlaneField& plane) {
  return fmt::format("{}/{}", kCalibration, plane.name);
}

std::optional<PowerLaw> read_power_law(const hdf5::File& file, const hdf5::Attributes& skin) {
  std::optional<PowerLaw> law;
  const char* missing = nullptr;
  for (const auto& [field, member] : kPowerLawFields) {
    const auto value = skin.number(field.name);
    if (!value) {
      missing = field.name;
      continue;
    }
    if (!law) law.emplace();
    (*law).*member = *value;
  }
  if (!law || missing == nullptr) return law;
  throw Error(fmt::format("{}: {}", file.path.string(), kSkinGroup),
              fmt::format("has no attribute '{}'", missing), "a power law needs both attributes");
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

void write(const hdf5::File& file, const std::string& name, const Skin& skin,
           const std::vector<float>& plane) {
  if (plane.empty()) return;
  hdf5::write_plane(file, name.c_str(), H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, skin.rows, skin.cols,
                    plane.data());
}

void write(const hdf5::File& file, const std::string& name, const Skin& skin,
           const std::vector<std::uint8_t>& mask) {
  if (mask.empty()) return;
  hdf5::write_plane(file, name.c_str(), H5T_STD_U8LE, H5T_NATIVE_UINT8, skin.rows, skin.cols,
                    mask.data());
}

}  // namespace

std::optional<SkinLayout> read_layout(const hdf5::Attributes& attributes, const hdf5::File& file) {
  const auto name = attributes.text(kLayout);
  if (!name) return std::nullopt;
  if (const auto layout = layout_named(*name)) return layout;
  throw Error(file.path.string(), fmt::format("its layout is '{:.40}'", *name),
              "it must be pillars or sensels");
}

void write_effects(const hdf5::File& file, const char* place, const SensorEffects& effects) {
  if (effects.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, place);
  const hdf5::Attributes attributes(file, group.get());
  for (const EffectParameter& parameter : parameters_of(effects)) {
    parameter.list ? attributes.write(parameter.name, parameter.values)
                   : attributes.write(parameter.name, parameter.values.front());
  }
}

SensorEffects read_effects(const hdf5::File& file, const char* place) {
  if (!hdf5::exists(file, place)) return {};
  const hdf5::Handle group = hdf5::open_object(file, place);
  const hdf5::Attributes attributes(file, group.get());
  return effects_of([&](const EffectParameter& asked) { return attributes.numbers(asked.name); },
                    fmt::format("{}: {}", file.path.string(), place));
}

template <class Constants>
hdf5::Handle write_skin(const hdf5::File& file, const Constants& skin) {
  hdf5::Handle group = hdf5::create_group(file, kSkinGroup);
  const hdf5::Attributes attributes(file, group.get());
  attributes.write(kPitch, skin.sensel_pitch_mm);
  visit_constants(skin, [&](const NumberField& field, const auto& value) {
    attributes.write(field.name, value);
  });
  for (const auto& [field, member] : kPowerLawFields) {
    if (skin.power_law) attributes.write(field.name, (*skin.power_law).*member);
  }
  const std::optional<SkinLayout> layout = skin.layout;
  if (layout) attributes.write(kLayout, std::string(name_of(*layout)));
  if (skin.falling) attributes.write(kFalling, 1);
  return group;
}

template hdf5::Handle write_skin(const hdf5::File&, const Skin&);
template hdf5::Handle write_skin(const hdf5::File&, const SkinCalibration&);

hdf5::Handle open_skin(const hdf5::File& file) {
  if (!hdf5::exists(file, kSkinGroup)) return {};
  return hdf5::open_object(file, kSkinGroup);
}

template <class Constants>
void read_skin(const hdf5::File& file, Constants& skin) {
  const hdf5::Handle object = open_skin(file);
  if (!object.valid()) return;
  const hdf5::Attributes attributes(file, object.get());
  skin.sensel_pitch_mm = attributes.pitch(kPitch);
  visit_constants(skin, [&](const NumberField& field, std::optional<double>& value) {
    value = attributes.number(field.name);
  });
  skin.power_law = read_power_law(file, attributes);
  skin.layout = read_layout(attributes, file);
  skin.falling = attributes.number(kFalling).value_or(0) != 0;
}

template void read_skin(const hdf5::File&, StoredSkin&);
template void read_skin(const hdf5::File&, SkinCalibration&);

void write_planes(const hdf5::File& file, const Skin& skin, const Calibration& calibration) {
  if (calibration.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, kCalibration);
  visit_planes(calibration, [&](const PlaneField& field, const auto& plane) {
    if constexpr (std::is_same_v<decltype(plane), const std::vector<float>&>) {
      write(file, path_of(field), skin, plane);
    }
  });
  write_effects(file, kEffects, calibration.effects);
  // The mask comes last in files.
  write(file, fmt::format("{}/{}", kCalibration, kMaskName), skin, calibration.mask);
}

void rewrite_tare(const hdf5::File& file, const Calibration& calibration, double threshold_counts) {
  const hdf5::Handle skin = open_skin(file);
  hdf5::Attributes(file, skin.get()).rewrite(kThresholdName, threshold_counts);
  for (const auto& [name, plane] : {std::pair("/calibration/tare", &calibration.tare),
                                    std::pair("/calibration/noise", &calibration.noise)}) {
    if (plane->empty() || !hdf5::exists(file, name)) continue;
    hdf5::rewrite_plane(file, name, H5T_NATIVE_FLOAT, plane->data());
  }
}

Calibration read_planes(const hdf5::File& file, const Skin& skin, std::optional<SenselType> type) {
  const std::string place = fmt::format("{}: {}", file.path.string(), kCalibration);
  Calibration calibration;
  visit_planes(calibration, [&](const PlaneField& field, auto& plane) {
    const std::string name = path_of(field);
    if (!hdf5::exists(file, name)) return;
    const std::vector<float> values = hdf5::read_plane(file, name.c_str(), skin.rows, skin.cols);
    if constexpr (std::is_same_v<decltype(plane), std::vector<float>&>) {
      plane = values;
    } else {
      plane = mask_of(values, skin, place);
    }
  });
  calibration.effects = read_effects(file, kEffects);
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
  const hdf5::Attributes attributes(file, group.get());
  attributes.write(kShape, std::string(name_of(surface.shape)));
  if (surface.shape == SurfaceShape::height_map) {
    hdf5::write_plane(file, kHeights, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, pillars.rows, pillars.cols,
                      surface.heights_mm.data());
  } else if (surface.shape != SurfaceShape::plane) {
    attributes.write(kRadius, surface.radius_mm);
    attributes.write(kAxis, surface.axis_deg);
  }
}

std::optional<Surface> read_surface(const hdf5::File& file, const ElementGrid& pillars) {
  if (!hdf5::exists(file, kSurface)) return std::nullopt;
  const std::string place = fmt::format("{}: {}", file.path.string(), kSurface);
  const hdf5::Handle group = hdf5::open_object(file, kSurface);
  const hdf5::Attributes attributes(file, group.get());
  Surface surface;
  surface.shape = shape_named(attributes.text(kShape).value_or(""), place);
  if (surface.shape == SurfaceShape::height_map) {
    surface.heights_mm = hdf5::read_plane(file, kHeights, pillars.rows, pillars.cols);
  } else {
    surface.radius_mm = attributes.number(kRadius).value_or(surface.radius_mm);
    surface.axis_deg = attributes.number(kAxis).value_or(surface.axis_deg);
  }
  check(surface, pillars, place);
  return surface;
}

}  // namespace pillarfield
