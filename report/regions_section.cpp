// How much region 3 leaves open at worst, beside what the paper prints.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "report/section.h"
#include "report/table.h"
#include "solve/one_pillar.h"

namespace pillarfield::report {
namespace {

/// Half of what an angle ranges over at worst, and the ratio of the two readings where it does.
struct Worst {
  double half_width_rad = 0;
  double ratio = 0;

  void take(double width_rad, double at) {
    if (width_rad / 2 > half_width_rad) *this = {width_rad / 2, at};
  }
};

constexpr const char* kIntroduction = R"(## What region 3 leaves open

Two readings fix two of three numbers: the force lies on a segment, whose ends are stated with it
(`theta_low` and so on; [derivation](derivations/uncertainty.md)). The paper gives the largest half-widths of the angles with two
digits. A scan of the code's own ends, over ratios R of the two readings from 1 to {largest} in steps of {step}, finds

)";

constexpr const char* kEnd = R"(
Figure 5, below, draws the half-widths over R.
)";

}  // namespace

std::string regions_section(const Context& /*context*/) {
  constexpr int kStepsToOne = 2000;
  constexpr int kLargest = 50;
  Worst theta;
  Worst phi;
  for (int step = kStepsToOne; step <= kLargest * kStepsToOne; ++step) {
    const double ratio = static_cast<double>(step) / kStepsToOne;
    const auto ends = estimate_pillar<double>({ratio, 1, 0, 0}, {}, Estimator::direct).interval;
    theta.take(ends.theta_high - ends.theta_low, ratio);
    phi.take(ends.phi_high - ends.phi_low, ratio);
  }
  Table table("lrrrr", {"", "printed, rad", "measured, rad", "at R", "closed form, rad"});
  table.add({"θ", "0.32", fmt::format("{:.4f}", theta.half_width_rad),
             fmt::format("{:.2f}", theta.ratio),
             fmt::format("arctan(1/√2) / 2 = {:.4f}", std::atan(1 / std::numbers::sqrt2) / 2)});
  table.add({"φ", "0.07", fmt::format("{:.4f}", phi.half_width_rad),
             fmt::format("{:.2f}", phi.ratio),
             fmt::format("arctan(1/7) / 2 = {:.4f}", std::atan(1.0 / 7) / 2)});
  return fmt::format(kIntroduction, fmt::arg("largest", kLargest),
                     fmt::arg("step", 1.0 / kStepsToOne)) +
         table.text() + kEnd;
}

}  // namespace pillarfield::report
