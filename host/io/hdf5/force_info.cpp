#include "io/hdf5/force_info.h"

#include <fmt/format.h>

#include <string>

#include "io/force_format.h"
#include "io/hdf5/attribute.h"
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

constexpr const char* kEffectsOfForces = "/effects";
constexpr const char* kFirstFrame = "first_frame";
constexpr const char* kMagnitude = "/force/magnitude";
constexpr const char* kPressure = "/force/pressure";

/// Visits the attributes that need no more than their value, visit(name, member).
template <class Info, class Visit>
void visit_info(Info& info, Visit visit) {
  visit("estimator", info.estimator);
  visit("segment_point", info.segment_point);
  visit("device", info.device);
  visit("source", info.source);
}

std::uint64_t read_first_frame(const hdf5::File& file) {
  const auto first = hdf5::Attributes(file).number(kFirstFrame);
  if (!first) return 0;
  constexpr double kMost = 0x1p46;
  if (*first >= 0 && *first <= kMost) return static_cast<std::uint64_t>(*first);
  throw Error(file.path.string(), fmt::format("has no valid attribute '{}'", kFirstFrame),
              hdf5::kDamaged);
}

}  // namespace

void write_info(const hdf5::File& file, const ForceFileInfo& info,
                const std::filesystem::path& path) {
  const hdf5::Attributes root(file);
  root.write("format", std::string(force_format::kName));
  const bool has_pillars = info.layout == SkinLayout::pillars;
  root.write("version", has_pillars ? force_format::kSparseSince : force_format::kLayoutSince);
  if (!has_pillars) root.write("layout", std::string(name_of(info.layout)));
  root.write(force_format::kUnit, std::string("N"));
  root.write("sign_convention", std::string(has_pillars ? kConvention : kConventionOfSensels));
  visit_info(info, [&](const char* name, const auto& value) { root.write(name, value); });
  root.write("program_version", std::string(kVersion));
  root.write(force_format::pitch_of(info.layout), info.element_pitch_mm);
  write_effects(file, kEffectsOfForces, info.effects);
  if (info.first_frame > 0) root.write(kFirstFrame, static_cast<double>(info.first_frame));
  if (!info.surface) return;
  const ElementGrid pillars = {info.rows, info.cols, info.element_pitch_mm};
  check(*info.surface, pillars, path.c_str());
  write_surface(file, *info.surface, pillars);
}

void write_pressure_unit(const hdf5::File& file, const ForceFileInfo& info) {
  if (!info.pressure) return;
  const hdf5::Handle pressure = hdf5::open_object(file, kPressure);
  hdf5::Attributes(file, pressure.get())
      .write(force_format::kUnit, std::string(kPressureUnits.front().name));
}

void read_planes_of(const hdf5::File& file, ForceFileInfo& info) {
  info.layout = read_layout(hdf5::Attributes(file), file).value_or(SkinLayout::pillars);
  info.angles = hdf5::exists(file, kMagnitude);
  info.uncertainty = hdf5::exists(file, force_format::kUncertainty);
  info.pressure = hdf5::exists(file, kPressure);
}

void read_info(const hdf5::File& file, ForceFileInfo& info, std::vector<std::string>& warnings) {
  const hdf5::Attributes root(file);
  visit_info(info, [&](const char* name, auto& value) {
    if constexpr (requires { value.reset(); }) {
      value = root.number(name);
    } else {
      value = root.text(name).value_or("");
    }
  });
  info.effects = read_effects(file, kEffectsOfForces);
  check(info.effects, file.path.string());
  const char* const name = force_format::pitch_of(info.layout);
  const auto pitch_mm = root.pitch(name);
  if (pitch_mm && !pitch_mm->is_positive()) {
    throw Error(file.path.string(), fmt::format("{} is {}", name, text_of(*pitch_mm)),
                "it must be above zero");
  }
  Skin usual;
  usual.layout = info.layout;
  info.element_pitch_mm = pitch_mm.value_or(usual.element_pitch_mm());
  if (!pitch_mm) {
    warnings.push_back(fmt::format("The file has no {}; {:.6g} mm is assumed.", name,
                                   info.element_pitch_mm.col_mm));
  }
  info.surface = read_surface(file, {info.rows, info.cols, info.element_pitch_mm});
  if (info.contacts) info.contacts->surface = info.surface;
  info.first_frame = read_first_frame(file);
}

}  // namespace pillarfield
