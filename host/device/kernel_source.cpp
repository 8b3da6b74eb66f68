#include <fmt/format.h>

#include <string>

#include "core/force_scale.h"
#include "core/wake_levels.h"
#include "device/kernel_files.h"
#include "pillarfield/processor.h"

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

const char* sensel_macro(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "uchar";
    case SenselType::u16:
      return "ushort";
    case SenselType::f32:
      break;
  }
  return "float";
}

/// What a plan asks of the kernel, in the order of the stages.
std::vector<Definition> definitions(const SolverPlan& plan) {
  const Skin& skin = plan.skin;
  const Calibration& calibration = plan.calibration;
  const ForceScale scale = force_scale(skin.counts_per_newton);
  std::vector<Definition> all;
  const auto add = [&](bool wanted, const char* macro, std::string value, const char* stage) {
    if (wanted) all.push_back({macro, std::move(value), stage});
  };
  const bool floating = plan.sensel_type == SenselType::f32;
  add(true, "PF_SENSEL", sensel_macro(plan.sensel_type), "load");
  add(floating, "PF_LARGEST_READING", hex_float(kMaxCounts), "reject_absurd");
  add(!calibration.mask.empty(), "PF_MASK", "", "mask");
  if (skin.full_scale_counts) {
    add(true, "PF_FULL_SCALE", hex_float(*skin.full_scale_counts), "saturation");
  }
  add(!calibration.tare.empty() || plan.baseline_rate, "PF_TARE", "", "tare");
  add(!calibration.gain.empty(), "PF_GAIN", "", "gain");
  if (skin.power_law) {
    add(true, "PF_POWER_EXPONENT", hex_float(skin.power_law->exponent), "power_law");
    add(true, "PF_POWER_REFERENCE", hex_float(skin.power_law->reference_counts), nullptr);
    add(true, "PF_POWER_LARGEST", hex_float(kMaxCounts), nullptr);
  }
  add(true, "PF_THRESHOLD", hex_float(skin.threshold_counts), "classify");
  add(!calibration.dead_zone.empty(), "PF_DEAD_ZONE", "", "dead_zone");
  const bool paper = plan.estimator == Estimator::paper;
  add(true, "PF_SHEAR_SCALE", hex_float(scale.shear), paper ? "paper_solve" : "direct_solve");
  add(true, "PF_NORMAL_SCALE", hex_float(scale.normal), nullptr);
  add(paper, "PF_PAPER", "", nullptr);
  add(true, "PF_DOUBT", hex_float(region_doubt(plan)), nullptr);
  if (plan.parity_tolerance_counts) {
    add(true, "PF_PARITY_TOLERANCE", hex_float(*plan.parity_tolerance_counts), "parity_test");
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

}  // namespace

std::vector<std::string> kernel_stages(const SolverPlan& plan) {
  std::vector<std::string> stages;
  for (const Definition& definition : definitions(plan)) {
    if (definition.stage != nullptr) stages.emplace_back(definition.stage);
  }
  stages.emplace_back(plan.half_output ? "store_half" : "store");
  if (plan.baseline_rate) stages.emplace_back("follow_baseline");
  return stages;
}

std::string kernel_source(const SolverPlan& plan, int lanes, const SpeedPaths& paths) {
  std::string source = fmt::format("#define PF_LANES {}\n", lanes);
  const auto define = [&](const std::vector<Definition>& all) {
    for (const Definition& definition : all) {
      source += fmt::format("#define {} {}\n", definition.macro, definition.value);
    }
  };
  define(definitions(plan));
  if (paths.skip_silent) define(silence_definitions(plan));
  for (const KernelFile& file : kernel_files()) {
    source += fmt::format("#line 1 \"{}\"\n", file.name);
    source += file.text;
  }
  return source;
}

}  // namespace pillarfield
