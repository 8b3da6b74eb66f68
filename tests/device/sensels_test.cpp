// Skins without pillars: the device has the bits of the host, for even and odd sizes, on every
// path, and both have the forces of a plain loop.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

struct Path {
  std::uint32_t rows;
  std::uint32_t cols;
  SenselType type;
  int lanes;
  Memory memory;
  Stores stores = Stores::cached;
};

std::string name_of_path(const testing::TestParamInfo<Path>& path) {
  const Path& each = path.param;
  return std::to_string(each.rows) + "x" + std::to_string(each.cols) + "_" + name_of(each.type) +
         "_lanes" + std::to_string(each.lanes) +
         (each.memory == Memory::shared ? "_shared" : "_staged");
}

SolverPlan without_pillars(SolverPlan plan) {
  plan.skin.layout = SkinLayout::sensels;
  plan.parity_tolerance_counts.reset();
  return plan;
}

/// All corrections that a skin without pillars may have.
SolverPlan corrected_plan(const Path& path) {
  const double unit = path.type == SenselType::u16 ? 16 : 1;
  SolverPlan plan = without_pillars(full_plan(path.rows, path.cols, path.type, 7));
  plan.skin.threshold_counts = 12 * unit;
  plan.noise_counts = 1;
  plan.uncertainty = true;
  plan.baseline_rate = 0.05;
  SensorEffects& effects = plan.calibration.effects;
  effects.curve = {{20 * unit, 60 * unit, 130 * unit, 220 * unit},
                   {15 * unit, 55 * unit, 140 * unit, 270 * unit}};
  effects.sensel_leak = {0.05, 0.05};
  effects.wires = {16, 24, 1e-5 / unit, 2e-5 / unit, 1.5e-5 / unit};
  effects.memory = {{{0, 0.05}, {30 * unit, 0.04}}, {{0.05, 0.03}}};
  effects.residual = {0.02, 0.3};
  return plan;
}

SolverPlan bent_plan(const Path& path) {
  const double unit = path.type == SenselType::u16 ? 16 : 1;
  SolverPlan plan = without_pillars(full_plan(path.rows, path.cols, path.type, 7));
  plan.skin.threshold_counts = 12 * unit;
  plan.noise_counts = 1;
  auto& planes = plan.calibration;
  for (auto* plane : {&planes.bend_x, &planes.bend_y, &planes.bend_xy}) {
    plane->assign(plan.skin.sensels(), 0);
    for (std::size_t i = 0; i < plane->size(); ++i) {
      (*plane)[i] = static_cast<float>(unit * (static_cast<double>(i * 37 % 101) - 50));
    }
  }
  return plan;
}

class SenselsOnDevice : public OnDevice<Path> {
 protected:
  static void expect_host_bits(const SolverPlan& plan) {
    const Path& path = GetParam();
    Processor processor(test_device(), plan, {.memory = path.memory},
                        {.lanes = tested_lanes(path.lanes), .paths = {.stores = path.stores}});
    HostReference host(plan);
    for (std::uint32_t number = 0; number < 12; ++number) {
      SCOPED_TRACE(number);
      // Every other frame is idle in most blocks.
      const RandomFrame touched(plan, number % 3, number);
      const FrameBuffer idle(path.type, path.rows, path.cols);
      const FrameView frame = number % 2 == 0 ? touched.view() : idle.view();
      processor.submit(frame);
      const ForceFieldView solved = processor.receive();
      EXPECT_EQ(solved.rows, path.rows);
      EXPECT_EQ(solved.cols, path.cols);
      expect_same_planes(solved, host.solve(frame));
    }
    if (!plan.baseline_rate) return;
    expect_same_bits(processor.tare(), host.tare(), "tare");
  }
};

TEST_P(SenselsOnDevice, BareHaveTheBitsOfTheHost) {
  expect_host_bits(without_pillars(bare_plan(GetParam().rows, GetParam().cols, GetParam().type)));
}

TEST_P(SenselsOnDevice, CorrectedHaveTheBitsOfTheHost) {
  expect_host_bits(corrected_plan(GetParam()));
}

TEST_P(SenselsOnDevice, BentHaveTheBitsOfTheHost) { expect_host_bits(bent_plan(GetParam())); }

/// Planes that sensels cannot determine are absent.
TEST_P(SenselsOnDevice, HaveNeitherShearNorAngles) {
  const Path& path = GetParam();
  SolverPlan plan = without_pillars(bare_plan(path.rows, path.cols, path.type));
  plan.uncertainty = true;
  plan.noise_counts = 1;
  Processor processor(test_device(), plan, {}, {.lanes = tested_lanes(path.lanes)});
  const RandomFrame frame(plan, 0, 1);
  processor.submit(frame.view());
  const ForceFieldView solved = processor.receive();
  EXPECT_TRUE(solved.shear_x.empty() && solved.shear_y.empty() && solved.theta.empty());
  for (std::size_t i = 0; i < kUncertaintyPlanes; ++i) {
    const auto plane = static_cast<Uncertainty>(i);
    EXPECT_EQ(solved.uncertainty[plane].empty(), plane != Uncertainty::normal) << name_of(plane);
  }
}

constexpr Path kPaths[] = {{38, 96, SenselType::u8, 16, Memory::shared, Stores::streaming},
                           {63, 33, SenselType::u8, 8, Memory::staged},
                           {13, 7, SenselType::f32, 1, Memory::shared},
                           {16, 45, SenselType::u16, 4, Memory::shared}};
INSTANTIATE_TEST_SUITE_P(Device, SenselsOnDevice, testing::ValuesIn(kPaths), name_of_path);

/// An oracle that shares nothing with the kernels.
TEST(Sensels, HaveTheForcesOfAPlainLoop) {
  constexpr float kLargest = std::numeric_limits<float>::infinity();
  SolverPlan plan = without_pillars(full_plan(11, 9, SenselType::f32, 3));
  plan.skin.threshold_counts = 5;
  plan.calibration.dead_zone.clear();
  plan.uncertainty = true;
  const RandomFrame random(plan, 0, 5);
  const FrameView frame = random.view();
  const ForceField solved = solve_on_host(plan, frame);
  const Calibration& planes = plan.calibration;
  int usable = 0;
  for (std::size_t i = 0; i < plan.skin.sensels(); ++i) {
    const float raw = static_cast<const float*>(frame.data)[i];
    const float counts = (raw - planes.tare[i]) * planes.gain[i];
    const bool missing = planes.mask[i] != kGood || !(std::abs(raw) < kLargest);
    const bool saturated = !missing && raw >= *plan.skin.full_scale_counts;
    const bool pressed = !missing && counts > 5;
    const double expected = pressed ? counts / plan.skin.counts_per_newton : 0;
    EXPECT_NEAR(solved.normal[i], expected, 1e-6 * (1 + expected));
    const bool lost = missing ? planes.mask[i] != kAbsent : saturated && !pressed;
    EXPECT_EQ(solved.status[i], (pressed && !saturated ? status::kSensel1 : 0) |
                                    (pressed && saturated ? status::kSaturated : 0) |
                                    (lost ? status::kInconsistent : 0));
    const float deviation = solved.uncertainty[Uncertainty::normal][i];
    if (pressed && !saturated) {
      ++usable;
      const double noise = planes.noise[i] * planes.gain[i] / plan.skin.counts_per_newton;
      EXPECT_NEAR(deviation, noise, 1e-5 * noise);
    } else {
      EXPECT_EQ(deviation, lost || (pressed && saturated) ? kOpenN : 0);
    }
  }
  EXPECT_GT(usable, 20);
}

TEST(Sensels, RefuseWhatOnlyPillarsHave) {
  const SolverPlan plan = without_pillars(bare_plan(8, 8, SenselType::u8));
  const auto expect_refused = [&](const auto& change) {
    SolverPlan changed = plan;
    change(changed);
    EXPECT_THROW(check(changed, "plan"), Error);
  };
  check(plan, "plan");
  expect_refused([](SolverPlan& p) { p.estimator = Estimator::contact; });
  expect_refused([](SolverPlan& p) { p.estimator = Estimator::paper; });
  expect_refused([](SolverPlan& p) { p.parity_tolerance_counts = 3; });
  expect_refused([](SolverPlan& p) { p.angles = true; });
  expect_refused([](SolverPlan& p) { p.calibration.effects.arm_mm = 0.3; });
  expect_refused([](SolverPlan& p) { p.calibration.effects.pillar_leak = {0.02, 0.01}; });
  expect_refused([](SolverPlan& p) { p.calibration.effects.shear_coefficient = {0.9, 1}; });
}

}  // namespace
}  // namespace pillarfield
