// The table of the settings that are numbers: a row is all that the command line, scenes, the
// Python package, pickles and the viewer know of its setting.

#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/named.h"
#include "base/range.h"
#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"
#include "skin/limits.h"

namespace pillarfield {

/// Reads and sets a number of a plan; by default none. An unset value leaves a number that is not
/// optional.
struct PlanNumber {
  std::optional<double> (*get)(const SolverPlan&) = [](const SolverPlan&) {
    return std::optional<double>();
  };
  void (*set)(SolverPlan&, std::optional<double>) = [](SolverPlan&, std::optional<double>) {};
};

template <class Member>
void set_number(Member& member, std::optional<double> value) {
  if constexpr (std::is_same_v<Member, std::optional<double>>) {
    member = value;
  } else if constexpr (std::is_integral_v<Member>) {
    using Limits = std::numeric_limits<Member>;
    if (value)
      member = *value < Limits::max() ? static_cast<Member>(std::fmax(*value, Limits::lowest()))
                                      : Limits::max();
  } else if (value) {
    member = static_cast<Member>(*value);
  }
}

/// The number at the end of a path of members.
template <auto... path>
inline constexpr PlanNumber kNumber = {
    [](const SolverPlan& plan) { return std::optional<double>((plan.*....*path)); },
    [](SolverPlan& plan, std::optional<double> value) { set_number((plan.*....*path), value); }};

/// Properties of a setting.
enum SettingTrait : unsigned {
  kIsKey = 1,    ///< a key of [solver] in scenes
  kIsShown = 2,  ///< an option of the viewer, too
  kIsWhole = 4,  ///< a whole number
};

/// A setting: a number of PlanSettings and the member of the plan that it sets.
struct PlanSetting {
  const char* name = "";  ///< in Python and in scenes
  std::optional<double> PlanSettings::*member = nullptr;
  PlanNumber number;  ///< empty: build_plan() applies the setting
  Range range;
  const char* unit = "";
  const char* help = "";         ///< one sentence, with the default in brackets
  const char* option = nullptr;  ///< of the command line; nullptr: none
  const char* heading = "";      ///< of its help
  unsigned traits = 0;           ///< of SettingTrait

  [[nodiscard]] constexpr bool has(unsigned trait) const { return (traits & trait) != 0; }
};

inline constexpr Range kReadings = {0, kMaxCounts};
inline constexpr Range kNoises = {0, kMaxNoiseCounts};
inline constexpr Range kBaselineIntervals = {1, 1024};  ///< frames
inline constexpr Range kFrameIntervalS = {0, 1e6, true};
inline constexpr Range kCountsOfNewton = {kMinCountsPerNewton, kMaxCountsPerNewton};

inline constexpr PlanSetting kPlanSettings[] = {
    {"threshold_counts", &PlanSettings::threshold_counts,
     kNumber<&SolverPlan::skin, &Skin::threshold_counts>, kReadings, "COUNTS",
     "Readings above this are usable [the file's]", "--threshold", "Sensor", kIsShown},
    {"counts_per_newton", &PlanSettings::counts_per_newton,
     kNumber<&SolverPlan::skin, &Skin::counts_per_newton>, kCountsOfNewton, "COUNTS",
     "Counts per newton and pillar [the file's]", "--counts-per-newton", "Sensor", kIsShown},
    {"full_scale_counts", &PlanSettings::full_scale_counts,
     kNumber<&SolverPlan::skin, &Skin::full_scale_counts>, kReadings, "COUNTS",
     "Readings of this or more are saturated [the file's]", "--full-scale", "Sensor", kIsShown},
    {"noise_counts", &PlanSettings::noise_counts, kNumber<&SolverPlan::noise_counts>, kNoises,
     "COUNTS", "Standard deviation of a reading [the calibration's or scene's]", "--noise",
     "Sensor"},
    {"baseline_time_s",
     &PlanSettings::baseline_time_s,
     {},
     kBaselineTimeS,
     "SECONDS",
     "Time constant with which the tare of untouched sensels follows drift [constant tare]",
     "--follow-baseline",
     "Sensor",
     kIsKey},
    {"release_time_s", &PlanSettings::release_time_s, kNumber<&SolverPlan::release_time_s>,
     kBaselineTimeS, "SECONDS",
     "Time in which it takes in the rest that a touch leaves, up to a fifth of the touch [1]",
     "--release-time", "Sensor"},
    {"baseline_interval", &PlanSettings::baseline_interval, kNumber<&SolverPlan::baseline_interval>,
     kBaselineIntervals, "N",
     "Follow it in one of N pillar rows per frame, at 1/N of the cost [a hundredth of SECONDS, a "
     "fortieth of --release-time]",
     "--baseline-interval", "Sensor", kIsWhole},
    {"frame_interval_s", &PlanSettings::frame_interval_s, kNumber<&SolverPlan::frame_interval_s>,
     kFrameIntervalS, "SECONDS", "Time from frame to frame [the frames']"},
    {"parity_tolerance_counts", &PlanSettings::parity_tolerance_counts,
     kNumber<&SolverPlan::parity_tolerance_counts>, kReadings, "COUNTS",
     "Flag pillars whose parity residual is larger [not tested]", "--parity-tolerance", "Solver",
     kIsKey},
    {"friction", &PlanSettings::friction, kNumber<&SolverPlan::friction, &FrictionKnowledge::given>,
     kFrictions, "RATIO", "Friction coefficient of all contacts, known to 3 % [estimated]",
     "--friction", "Friction", kIsKey},
    {"friction_bound", &PlanSettings::friction_bound,
     kNumber<&SolverPlan::friction, &FrictionKnowledge::bound>, kFrictionBound, "RATIO",
     "Upper bound of friction coefficients [none]", "--friction-bound", "Friction", kIsKey},
};

/// A plane beside the forces.
struct PlanOutput {
  const char* name = "";
  std::optional<bool> PlanSettings::*member = nullptr;
  bool SolverPlan::*flag = nullptr;
};

inline constexpr std::array<PlanOutput, 3> kPlanOutputs = {{
    {"angles", &PlanSettings::angles, &SolverPlan::angles},
    {"uncertainty", &PlanSettings::uncertainty, &SolverPlan::uncertainty},
    {"pressure", &PlanSettings::pressure, &SolverPlan::pressure},
}};

/// Turns each plane on or off, as `words` name it or not.
void set_outputs(const std::vector<std::string>& words, PlanSettings& settings);

inline constexpr std::array<Named<Estimator>, 3> kEstimators = {{
    {"direct", Estimator::direct},
    {"paper", Estimator::paper},
    {"contact", Estimator::contact},
}};

}  // namespace pillarfield
