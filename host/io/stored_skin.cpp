#include "io/stored_skin.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5_attribute.h"
#include "io/hdf5_links.h"
#include "io/hdf5_plane.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

namespace layout = recording_format;

/// A plane of floats, its name in the file, and where it is kept.
struct FloatPlane {
  const char* name;
  std::vector<float> Calibration::*member;
};
constexpr FloatPlane kFloatPlanes[] = {{layout::kTare, &Calibration::tare},
                                       {layout::kGain, &Calibration::gain},
                                       {layout::kDeadZone, &Calibration::dead_zone},
                                       {layout::kNoise, &Calibration::noise}};

std::optional<PowerLaw> read_power_law(const hdf5::File& file, hid_t skin) {
  const auto exponent = hdf5::read_number(file, skin, layout::kExponent);
  const auto reference_counts = hdf5::read_number(file, skin, layout::kReference);
  if (!exponent && !reference_counts) return std::nullopt;
  if (!exponent || !reference_counts) {
    throw Error(
        fmt::format("{}: {}", file.path.string(), layout::kSkin),
        fmt::format("has no attribute '{}'", exponent ? layout::kReference : layout::kExponent),
        "a power law needs both its numbers");
  }
  return PowerLaw{*exponent, *reference_counts};
}

/// A mask may be stored as numbers of any type.
std::vector<std::uint8_t> mask_of(const std::vector<float>& plane, const Skin& skin,
                                  const std::string& place) {
  std::vector<std::uint8_t> mask(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    if (plane[i] != 0.0f && plane[i] != 1.0f) {
      throw Error(place,
                  fmt::format("calibration plane 'mask' is {} at row {}, column {}", plane[i],
                              i / skin.cols, i % skin.cols),
                  "it must be 0 or 1");
    }
    mask[i] = plane[i] == 1.0f ? 1 : 0;
  }
  return mask;
}

}  // namespace

hdf5::Handle write_skin(const hdf5::File& file, const StoredSkin& skin) {
  hdf5::Handle group = hdf5::create_group(file, layout::kSkin);
  const auto write = [&](const char* name, const std::optional<double>& value) {
    if (value) hdf5::write_attribute(file, group.get(), name, *value);
  };
  write(layout::kPitch, skin.sensel_pitch_mm);
  write(layout::kCountsPerNewton, skin.counts_per_newton);
  write(layout::kThreshold, skin.threshold_counts);
  write(layout::kFullScale, skin.full_scale_counts);
  if (skin.power_law) {
    write(layout::kExponent, skin.power_law->exponent);
    write(layout::kReference, skin.power_law->reference_counts);
  }
  return group;
}

hdf5::Handle open_skin(const hdf5::File& file) {
  if (!hdf5::exists(file, layout::kSkin)) return {};
  return hdf5::open_object(file, layout::kSkin);
}

StoredSkin read_skin(const hdf5::File& file) {
  const hdf5::Handle object = open_skin(file);
  if (!object.valid()) return {};
  const auto read = [&](const char* name) { return hdf5::read_number(file, object.get(), name); };
  return {read(layout::kPitch), read(layout::kCountsPerNewton), read(layout::kThreshold),
          read(layout::kFullScale), read_power_law(file, object.get())};
}

void write_planes(const hdf5::File& file, const Skin& skin, const Calibration& calibration) {
  if (calibration.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, layout::kCalibration);
  for (const auto& [name, member] : kFloatPlanes) {
    const std::vector<float>& plane = calibration.*member;
    if (plane.empty()) continue;
    hdf5::write_plane(file, name, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, skin.rows, skin.cols,
                      plane.data());
  }
  if (calibration.mask.empty()) return;
  hdf5::write_plane(file, layout::kMask, H5T_STD_U8LE, H5T_NATIVE_UINT8, skin.rows, skin.cols,
                    calibration.mask.data());
}

Calibration read_planes(const hdf5::File& file, const Skin& skin, std::optional<SenselType> type) {
  const auto plane = [&](const char* name) {
    if (!hdf5::exists(file, name)) return std::vector<float>();
    return hdf5::read_plane(file, name, skin.rows, skin.cols);
  };
  Calibration calibration;
  for (const auto& [name, member] : kFloatPlanes) calibration.*member = plane(name);
  const std::string place = fmt::format("{}: {}", file.path.string(), layout::kCalibration);
  calibration.mask = mask_of(plane(layout::kMask), skin, place);
  check(calibration, skin, place, type);
  return calibration;
}

}  // namespace pillarfield
