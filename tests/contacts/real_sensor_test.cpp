// The estimator `contact` on skins with a shear coefficient, off-centre pressure, a leak between
// pillars and residual errors: its error against the paper's midpoint, as on the ideal skin, and
// what its intervals hold.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "dragged_indenters.h"

namespace pillarfield {
namespace {

constexpr double kFriction = 1.6;
constexpr Indenter (*kIndenters[])() = {fingertip, ball, punch};

/// Properties that distinguish a sensor from an ideal one.
struct Sensor {
  const char* name = "ideal";
  double most_above_ideal = 0;  ///< of the ratio to the paper's midpoint
  std::optional<ShearCoefficient> shear_coefficient = {};
  double leak_edge = 0;
  double leak_corner = 0;
  double gain_spread = 0;
  std::optional<double> arm_mm = {};
};

Scene with(const Sensor& sensor, Indenter (*indenter)()) {
  Scene scene = dragged(indenter(), kFriction);
  scene.sensor.effects.shear_coefficient = sensor.shear_coefficient;
  if (sensor.leak_edge != 0)
    scene.sensor.effects.pillar_leak = {sensor.leak_edge, sensor.leak_corner};
  scene.sensor.gain_spread = sensor.gain_spread;
  scene.sensor.effects.arm_mm = sensor.arm_mm;
  return scene;
}

Errors direct_errors(const Simulator& simulator) {
  const SolverPlan plan = plan_of(simulator.scene(), Estimator::direct);
  return errors_of(
      simulator, [&](const FrameView& frame) { return solve_on_host(plan, frame); },
      plan.segment_point);
}

const Sensor kSensors[] = {
    {"coefficient 0.9", 0.03, ShearCoefficient{0.9, 0.9}},
    {"coefficients 0.9, 1.1", 0.03, ShearCoefficient{0.9, 1.1}},
    {"coefficient 1.3", 0.1, ShearCoefficient{1.3, 1.3}},
    {"leak", 0.01, {}, 0.02, 0.005},
    {.name = "gains of 5 %", .most_above_ideal = 0.15, .gain_spread = 0.05},
    {.name = "arm 0.5 mm", .most_above_ideal = 0.14, .arm_mm = 0.5},
    // The lean that the correction leaves moves the segments themselves (segment.md, section 3).
    // The pillars around bring the midpoint nearer too (E7a): its error falls by more.
    {.name = "arm 0.224 mm", .most_above_ideal = 0.41, .arm_mm = 0.224},
};

/// Shares of the true components that lie between their ends.
void expect_coverage(const Errors& errors) {
  // The lean's stated deviation holds less under a punch.
  EXPECT_GT(errors.between[0], 0.91 * errors.pillars);
  EXPECT_GT(errors.between[1], 0.91 * errors.pillars);
  EXPECT_GT(errors.between[2], 0.92 * errors.pillars);
}

TEST(RealSensor, AmbiguousPillarsAreEstimatedAsOnTheIdealOne) {
  std::array<double, 3> ideal{};
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const Simulator simulator(with({}, kIndenters[i]));
    ideal.at(i) = contact_errors(simulator).rms() / paper_errors(simulator).rms();
  }
  for (const Sensor& sensor : kSensors) {
    SCOPED_TRACE(sensor.name);
    Errors direct;
    Errors contact;
    for (std::size_t i = 0; i < ideal.size(); ++i) {
      const Simulator simulator(with(sensor, kIndenters[i]));
      const Errors found = contact_errors(simulator);
      EXPECT_LT(found.rms() / paper_errors(simulator).rms(), ideal.at(i) + sensor.most_above_ideal);
      contact += found;
      direct += direct_errors(simulator);
    }
    expect_coverage(contact);
    expect_coverage(direct);
  }
}

/// A lean that the correction leaves moves segments; the estimate is then near that of `direct`,
/// at frictions where it was up to 1.7 times as far off.
TEST(RealSensor, LeaningPillarsAreNoWorseThanByDirect) {
  for (const double friction : {0.8, 1.2, 1.6, 2.2}) {
    SCOPED_TRACE(friction);
    Errors direct;
    Errors contact;
    const auto add = [&](Scene scene) {
      scene.sensor.effects.arm_mm = 0.224;
      const Simulator simulator(scene);
      contact += contact_errors(simulator);
      direct += direct_errors(simulator);
    };
    for (const auto indenter : kIndenters) add(dragged(indenter(), friction));
    add(turned(fingertip(), friction));
    add(turned(ball(), friction));
    EXPECT_GT(contact.pillars, 500);
    EXPECT_LT(contact.rms(), (friction < 1 ? 1.2 : 1.05) * direct.rms());
  }
}

/// Estimates stay on the segments of the corrected forces, whose slope is the coefficient's.
TEST(RealSensor, EstimatesExplainTheReadings) {
  const Scene scene =
      with({.shear_coefficient = ShearCoefficient{0.9, 1.2}, .arm_mm = 0.3}, fingertip);
  const Simulator simulator(scene);
  FrameBuffer raw(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  ForceField truth(26, 26);
  int ambiguous = 0;
  for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
    simulator.render(frame, raw, truth);
    const ForceField direct = solve_on_host(plan_of(scene, Estimator::direct), raw.view());
    const ForceField contact = solve_on_host(plan_of(scene, Estimator::contact), raw.view());
    for (std::size_t i = 0; i < direct.elements(); ++i) {
      if (!is_ambiguous_pair(direct.status[i])) continue;
      ++ambiguous;
      const int usable = direct.status[i] & status::kUsable;
      const bool vertical = usable == 3 || usable == 12;
      const double slope = (usable == 3 || usable == 9 ? 1 : -1) * std::sqrt(2.0);
      const auto read = [&](const ForceField& field) {
        return vertical ? 1.2 * field.shear_y[i] + slope * field.normal[i]
                        : 0.9 * field.shear_x[i] + slope * field.normal[i];
      };
      EXPECT_NEAR(read(contact), read(direct), 1e-5);
    }
  }
  EXPECT_GT(ambiguous, 50);
}

}  // namespace
}  // namespace pillarfield
