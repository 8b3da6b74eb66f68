// The table of the numbers among PlanSettings, over which the command line and the Python package
// iterate.

#pragma once

#include <optional>

#include "base/range.h"
#include "pillarfield/calibration.h"
#include "pillarfield/plan_builder.h"
#include "pillarfield/skin.h"
#include "skin/limits.h"

namespace pillarfield {

/// A number of the settings.
struct PlanSetting {
  const char* name = "";  ///< in Python
  std::optional<double> PlanSettings::*member = nullptr;
  const char* option = nullptr;  ///< of the command line; nullptr: none
  const char* heading = "";      ///< of its help
  const char* unit = "";
  Range range;
  bool whole = false;
  const char* help = "";  ///< one sentence, with the default in brackets
};

inline constexpr Range kReadings = {0, kMaxCounts};
inline constexpr Range kNoises = {0, kMaxNoiseCounts};
inline constexpr Range kCountsOfNewton = {kMinCountsPerNewton, kMaxCountsPerNewton};

inline constexpr PlanSetting kPlanSettings[] = {
    {"threshold_counts", &PlanSettings::threshold_counts, "--threshold", "Sensor", "COUNTS",
     kReadings, false, "Readings above this are usable [the file's]"},
    {"counts_per_newton", &PlanSettings::counts_per_newton, "--counts-per-newton", "Sensor",
     "COUNTS", kCountsOfNewton, false, "Counts per newton and pillar [the file's]"},
    {"full_scale_counts", &PlanSettings::full_scale_counts, "--full-scale", "Sensor", "COUNTS",
     kReadings, false, "Readings of this or more are saturated [the file's]"},
    {"noise_counts", &PlanSettings::noise_counts, "--noise", "Sensor", "COUNTS", kNoises, false,
     "Standard deviation of a reading [the calibration's or scene's]"},
    {"baseline_time_s", &PlanSettings::baseline_time_s, "--follow-baseline", "Sensor", "SECONDS",
     kBaselineTimeS, false,
     "Time constant with which the tare of untouched sensels follows drift [constant tare]"},
    {"baseline_interval",
     &PlanSettings::baseline_interval,
     "--baseline-interval",
     "Sensor",
     "N",
     {1, 1024},
     true,
     "Follow it in one of N pillar rows per frame, at 1/N of the cost [a hundredth of SECONDS]"},
    {"frame_interval_s", &PlanSettings::frame_interval_s, nullptr, "", "", {}, false, ""},
    {"parity_tolerance_counts", &PlanSettings::parity_tolerance_counts, "--parity-tolerance",
     "Solver", "COUNTS", kReadings, false,
     "Flag pillars whose parity residual is larger [not tested]"},
    {"friction", &PlanSettings::friction, "--friction", "Friction", "RATIO", kFrictions, false,
     "Friction coefficient of all contacts, known to 3 % [estimated]"},
    {"friction_bound", &PlanSettings::friction_bound, "--friction-bound", "Friction", "RATIO",
     kFrictionBound, false, "Upper bound of friction coefficients [none]"},
};

/// "angles" and "uncertainty", beside the forces.
inline constexpr const char* kPlanOutputs[] = {"angles", "uncertainty", "pressure"};

}  // namespace pillarfield
