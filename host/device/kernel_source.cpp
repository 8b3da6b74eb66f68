#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "device/block_lanes.h"
#include "device/kernel_files.h"
#include "device/sensel_macro.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/wake_levels.h"

namespace pillarfield {
namespace {

/// One `#define` of the program's first lines and the stage that it switches on.
struct Definition {
  const char* macro;
  std::string value;
  const char* stage;  ///< nullptr: a constant that every program has
};

/// A constant as the device gets it: rounded to single precision, then exact.
std::string hex_float(double value) { return fmt::format("{:a}f", static_cast<float>(value)); }

/// Whole numbers stand for sixteenths of a count: readings are whole counts, a threshold is whole
/// or a half, and so is their sum, of which the segment point leaves an eighth at least.
constexpr int kUnitsPerCount = 16;

/// Thresholds beyond are not made whole: four of them fit into 16 bits.
constexpr double kLargestWholeThreshold = 500;

/// Counts beyond which a constant is like any larger one to readings of 8 bits; it fits as well.
constexpr double kManyCounts = 1000;

/// The segment point as programs of whole numbers take it: n where it is 1 - 1 / 2^n.
std::optional<int> whole_segment_point(const SolverPlan& plan) {
  for (int n = 1; n <= 3; ++n) {
    if (plan.segment_point == 1 - std::ldexp(1.0, -n)) return n;
  }
  return std::nullopt;
}

/// Whether all that the solve of a plan computes in counts is a whole number of sixteenths, and no
/// sensel is missing (docs/derivations/direct_solve.md, section 6).
bool is_whole(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  const auto threshold = static_cast<float>(plan.skin.threshold_counts);
  const bool corrects = !calibration.tare.empty() || !calibration.gain.empty() ||
                        !calibration.dead_zone.empty() || !calibration.mask.empty() ||
                        plan.baseline_rate || plan.skin.power_law;
  const bool halves =
      threshold <= kLargestWholeThreshold && 2 * threshold == std::floor(2 * threshold);
  const bool saturates_below =
      plan.skin.full_scale_counts && static_cast<float>(*plan.skin.full_scale_counts) <= threshold;
  return plan.sensel_type == SenselType::u8 && plan.estimator != Estimator::paper && !corrects &&
         !plan.angles && !plan.uncertainty && halves && !saturates_below &&
         whole_segment_point(plan);
}

/// A constant in counts with which readings and what is made of them are compared. As a whole
/// number it is rounded up or down such that whole numbers compare with it alike.
class CountsMacro {
 public:
  explicit CountsMacro(bool whole) : whole_(whole) {}
  /// For x > value.
  [[nodiscard]] std::string above(double value) const { return text(value, std::floor); }
  /// For x >= value, and x > -value.
  [[nodiscard]] std::string from(double value) const { return text(value, std::ceil); }

 private:
  [[nodiscard]] std::string text(double value, double (*round)(double)) const {
    if (!whole_) return hex_float(value);
    const double units = kUnitsPerCount * std::min<double>(static_cast<float>(value), kManyCounts);
    return fmt::format("{}", static_cast<int>(round(units)));
  }

  bool whole_;
};

/// What a plan asks of the kernel, in the order of the stages; `whole` if in whole numbers.
std::vector<Definition> definitions(const SolverPlan& plan, bool whole) {
  const Skin& skin = plan.skin;
  const Calibration& calibration = plan.calibration;
  const ForceScale scale = force_scale(skin.counts_per_newton);
  const int units_per_count = whole ? kUnitsPerCount : 1;
  const CountsMacro counts(whole);
  std::vector<Definition> all;
  const auto add = [&](bool wanted, const char* macro, std::string value, const char* stage) {
    if (wanted) all.push_back({macro, std::move(value), stage});
  };
  const bool floating = plan.sensel_type == SenselType::f32;
  add(true, "PF_SENSEL", sensel_macro(plan.sensel_type), "load");
  add(whole, "PF_WHOLE", fmt::format("{}", kUnitsPerCount), nullptr);
  add(floating, "PF_LARGEST_READING", hex_float(kMaxCounts), "reject_absurd");
  add(!calibration.mask.empty(), "PF_MASK", "", "mask");
  if (skin.full_scale_counts) {
    add(true, "PF_FULL_SCALE", counts.from(*skin.full_scale_counts), "saturation");
  }
  add(!calibration.tare.empty() || plan.baseline_rate, "PF_TARE", "", "tare");
  add(!calibration.gain.empty(), "PF_GAIN", "", "gain");
  if (skin.power_law) {
    add(true, "PF_POWER_EXPONENT", hex_float(skin.power_law->exponent), "power_law");
    add(true, "PF_POWER_REFERENCE", hex_float(skin.power_law->reference_counts), nullptr);
    add(true, "PF_POWER_LARGEST", hex_float(kMaxCounts), nullptr);
  }
  add(true, "PF_THRESHOLD", counts.above(skin.threshold_counts), "classify");
  add(!calibration.dead_zone.empty(), "PF_DEAD_ZONE", "", "dead_zone");
  const bool paper = plan.estimator == Estimator::paper;
  add(true, "PF_SHEAR_SCALE", hex_float(scale.shear / units_per_count),
      paper ? "paper_solve" : "direct_solve");
  add(true, "PF_NORMAL_SCALE", hex_float(scale.normal / units_per_count), nullptr);
  add(paper, "PF_PAPER", "", nullptr);
  add(true, "PF_SEGMENT_POINT",
      whole ? fmt::format("{}", *whole_segment_point(plan)) : hex_float(plan.segment_point),
      nullptr);
  add(true, "PF_DOUBT", counts.from(region_doubt(plan)), nullptr);
  if (plan.parity_tolerance_counts) {
    add(true, "PF_PARITY_TOLERANCE", counts.above(*plan.parity_tolerance_counts), "parity_test");
  }
  add(plan.angles, "PF_ANGLES", "", "angles");
  if (plan.uncertainty) {
    add(true, "PF_UNCERTAINTY", hex_float(reading_noise(plan)), "uncertainty");
    add(!calibration.noise.empty(), "PF_NOISE", "", nullptr);
  }
  add(plan.half_output, "PF_HALF", "", nullptr);
  add(plan.baseline_rate.has_value(), "PF_BASELINE", "", nullptr);
  return all;
}

/// What skipping silent blocks needs to know.
std::vector<Definition> silence_definitions(const SolverPlan& plan) {
  const WakeRange range = wake_range(plan);
  std::vector<Definition> all = {{"PF_SKIP_SILENT", "", nullptr}};
  if (has_wake_plane(plan)) {
    all.push_back({"PF_WAKE_PLANE", "", nullptr});
  } else {
    all.push_back({"PF_WAKE", hex_float(wake_levels(plan).front()), nullptr});
  }
  all.push_back({"PF_WAKE_THRESHOLD", hex_float(range.threshold), nullptr});
  all.push_back({"PF_WAKE_STEP", hex_float(range.step), nullptr});
  all.push_back({"PF_WAKE_LOWEST", hex_float(range.lowest), nullptr});
  all.push_back({"PF_WAKE_HIGHEST", hex_float(range.highest), nullptr});
  all.push_back({"PF_WAKE_NEVER", hex_float(range.never), nullptr});
  return all;
}

/// Appends a file, which compilers then know by its own lines.
void append(std::string& source, const KernelFile& file) {
  source += fmt::format("#line 1 \"{}\"\n", file.name);
  source += file.text;
}

/// Whether a program of whole numbers has a use for a file: the others are of fractions.
bool serves_whole_numbers(std::string_view file) {
  return file != "pillar/elementary.h" && file != "pillar/paper_solve.h" &&
         file != "pillar/angles.h" && file != "pillar/uncertainty.h";
}

}  // namespace

std::vector<std::string> kernel_stages(const SolverPlan& plan) {
  std::vector<std::string> stages;
  for (const Definition& definition : definitions(plan, false)) {
    if (definition.stage != nullptr) stages.emplace_back(definition.stage);
  }
  stages.emplace_back(plan.half_output ? "store_half" : "store");
  if (plan.baseline_rate) stages.emplace_back("follow_baseline");
  if (plan.estimator == Estimator::contact) stages.emplace_back("estimate_contacts");
  return stages;
}

std::string kernel_source(const SolverPlan& plan, int device_lanes, const SpeedPaths& paths) {
  const int lanes = block_lanes(device_lanes, plan.skin.pillar_cols());
  std::string source = fmt::format("#define PF_LANES {}\n", lanes);
  const auto define = [&](const std::vector<Definition>& all) {
    for (const Definition& definition : all) {
      source += fmt::format("#define {} {}\n", definition.macro, definition.value);
    }
  };
  // A lane of its own is 32 bits wide anyway.
  const bool whole = paths.whole_numbers && lanes > 1 && is_whole(plan);
  define(definitions(plan, whole));
  if (paths.stores == Stores::streaming && lanes > 1) define({{"PF_STREAM", "", nullptr}});
  if (paths.skip_silent) define(silence_definitions(plan));
  for (const KernelFile& file : kernel_files()) {
    if (!whole || serves_whole_numbers(file.name)) append(source, file);
  }
  return source;
}

}  // namespace pillarfield
