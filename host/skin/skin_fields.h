// The stored constants and planes of a skin with their names in files and their ranges: the one
// table of what checks, readers, writers and `info` visit (docs/formats.md).

#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// A number by its name in files, and its range.
struct NumberField {
  const char* name = "";
  double low = 0;
  double high = 0;
};

/// Throws Error, naming `where`, unless a value is in range.
void check_range(std::string_view where, const NumberField& field, double value);

inline constexpr const char* kThresholdName = "threshold_counts";
inline constexpr const char* kMaskName = "mask";

/// Visits the constants, visit(NumberField, member): those of Skin, StoredSkin or SkinCalibration.
template <class Constants, class Visit>
void visit_constants(Constants& of, Visit visit) {
  visit(NumberField{"counts_per_newton", kMinCountsPerNewton, kMaxCountsPerNewton},
        of.counts_per_newton);
  visit(NumberField{kThresholdName, 0, kMaxCounts}, of.threshold_counts);
  if constexpr (requires { of.full_scale_counts; }) {
    visit(NumberField{"full_scale_counts", 0, kMaxCounts}, of.full_scale_counts);
  }
}

inline constexpr NumberField kThresholdFactor = {"threshold_factor", 0, kMaxThresholdFactor};

/// The numbers of a power law.
struct PowerLawField {
  NumberField number;
  double PowerLaw::*member = nullptr;
};
inline constexpr PowerLawField kPowerLawFields[] = {
    {{"power_law_exponent", kMinExponent, kMaxExponent}, &PowerLaw::exponent},
    {{"power_law_reference_counts", kMinReferenceCounts, kMaxReferenceCounts},
     &PowerLaw::reference_counts}};

/// A plane by its name in files, and the range of its values; those of a reading are also at most
/// the largest reading.
struct PlaneField {
  const char* name = "";
  double low = 0;
  double high = 0;
  bool is_reading = false;

  [[nodiscard]] double low_for(double largest) const {
    return is_reading ? std::max(low, -largest) : low;
  }
  [[nodiscard]] double high_for(double largest) const {
    return is_reading ? std::min(high, largest) : high;
  }
};

/// Visits the planes, visit(PlaneField, member); the mask is of bytes, the others of floats.
template <class Planes, class Visit>
void visit_planes(Planes& of, Visit visit) {
  const auto bend = [](const char* name) {
    return PlaneField{name, -kMaxPlaneCounts, kMaxPlaneCounts};
  };
  visit(PlaneField{"tare", -kMaxPlaneCounts, kMaxPlaneCounts, true}, of.tare);
  visit(PlaneField{"gain", kMinGain, kMaxGain}, of.gain);
  visit(PlaneField{"dead_zone", 0, kMaxPlaneCounts, true}, of.dead_zone);
  visit(PlaneField{kMaskName, kMissing, kAbsent}, of.mask);
  visit(PlaneField{"noise", 0, kMaxNoiseCounts, true}, of.noise);
  visit(bend("bend_x"), of.bend_x);
  visit(bend("bend_y"), of.bend_y);
  visit(bend("bend_xy"), of.bend_xy);
}

}  // namespace pillarfield
