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
  if (info.first_frame > 0) {
    hdf5::write_attribute(file, root, force_format::kFirstFrame,
                          static_cast<double>(info.first_frame));
  }
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

std::uint64_t read_first_frame(const hdf5::File& file) {
  const auto first = hdf5::read_number(file, file.id.get(), force_format::kFirstFrame);
  if (!first) return 0;
  constexpr double kMost = 0x1p46;
  if (*first >= 0 && *first <= kMost) return static_cast<std::uint64_t>(*first);
  throw Error(file.path.string(),
              fmt::format("has no valid attribute '{}'", force_format::kFirstFrame),
              hdf5::kDamaged);
}

}  // namespace pillarfield
