#include "io/hdf5/force_info.h"

#include <fmt/format.h>

#include <string>

#include "io/force_format.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/version.h"

namespace pillarfield {
namespace {

constexpr const char* kConvention =
    "shear_x (+ right, growing column) and shear_y (+ up, falling row) act on the skin; normal is "
    "positive when pressed; (theta, phi) is the direction from which the force comes, rad";

constexpr const char* kConventionOfSensels = "normal is positive when pressed";

/// A whole number that an attribute may hold.
std::uint64_t read_count(const hdf5::File& file, hid_t group, const char* name) {
  constexpr double kMost = 0x1p46;  // A product with a number of parts fits in 64 bits.
  const auto value = hdf5::read_number(file, group, name);
  if (value && *value >= 0 && *value <= kMost) return static_cast<std::uint64_t>(*value);
  throw Error(file.path.string(), fmt::format("has no valid attribute '{}' of its parts", name),
              hdf5::kDamaged);
}

void write_part(const hdf5::File& file, const ForcePart& part) {
  const hdf5::Handle group = hdf5::create_group(file, force_format::kPart);
  const auto write = [&](const char* name, std::uint64_t value) {
    hdf5::write_attribute(file, group.get(), name, static_cast<double>(value));
  };
  write(force_format::kIndex, part.index);
  write(force_format::kCount, part.count);
  write(force_format::kFrames, part.frames);
  write(force_format::kCheckpointEvery, part.checkpoints.every);
  write(force_format::kWarmUp, part.checkpoints.warm_up);
  hdf5::write_attribute(file, group.get(), force_format::kFingerprint, part.fingerprint);
}

}  // namespace

void write_info(const hdf5::File& file, const ForceFileInfo& info,
                const std::filesystem::path& path) {
  const hid_t root = file.id.get();
  hdf5::write_attribute(file, root, "format", std::string(force_format::kName));
  const bool has_pillars = info.layout == SkinLayout::pillars;
  hdf5::write_attribute(file, root, "version",
                        has_pillars ? force_format::kSparseSince : force_format::kLayoutSince);
  if (!has_pillars) {
    hdf5::write_attribute(file, root, force_format::kLayout, std::string(name_of(info.layout)));
  }
  hdf5::write_attribute(file, root, force_format::kUnit, std::string("N"));
  hdf5::write_attribute(file, root, force_format::kSignConvention,
                        std::string(has_pillars ? kConvention : kConventionOfSensels));
  hdf5::write_attribute(file, root, force_format::kEstimator, info.estimator);
  if (info.segment_point) {
    hdf5::write_attribute(file, root, force_format::kSegmentPoint, *info.segment_point);
  }
  hdf5::write_attribute(file, root, force_format::kDevice, info.device);
  hdf5::write_attribute(file, root, force_format::kSource, info.source);
  hdf5::write_attribute(file, root, force_format::kProgramVersion, std::string(kVersion));
  write_pitch(file, root, force_format::pitch_of(info.layout), info.element_pitch_mm);
  write_effects(file, force_format::kEffects, info.effects);
  if (info.part) write_part(file, *info.part);
  if (!info.surface) return;
  const ElementGrid pillars = {info.rows, info.cols, info.element_pitch_mm};
  check(*info.surface, pillars, path.c_str());
  write_surface(file, *info.surface, pillars);
}

void write_pressure_unit(const hdf5::File& file, const ForceFileInfo& info) {
  if (!info.pressure) return;
  const hdf5::Handle pressure = hdf5::open_object(file, force_format::kPressure);
  hdf5::write_attribute(file, pressure.get(), force_format::kUnit,
                        std::string(kPressureUnits.front().name));
}

std::optional<ForcePart> read_part(const hdf5::File& file) {
  if (!hdf5::exists(file, force_format::kPart)) return std::nullopt;
  const hdf5::Handle group = hdf5::open_object(file, force_format::kPart);
  const auto count = [&](const char* name) { return read_count(file, group.get(), name); };
  ForcePart part;
  part.index = count(force_format::kIndex);
  part.count = count(force_format::kCount);
  part.frames = count(force_format::kFrames);
  part.checkpoints = {count(force_format::kCheckpointEvery), count(force_format::kWarmUp)};
  part.fingerprint = hdf5::read_text(file, group.get(), force_format::kFingerprint).value_or("");
  check(part, file.path.string());
  return part;
}

}  // namespace pillarfield
