// The estimator `contact` of a processor against direct solve and estimator in C++: 0 ULP with all
// kinds of memory and of friction.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

/// A spin, a partial slip, a slide and a roller, cut by the skin's borders in part.
constexpr const char* kScene = R"(
[skin]
pillars = [90, 137]
threshold_counts = 2
[sensor]
noise_counts = 0.5
adc_bits = 10
[time]
frames = 3
[[contact]]
shape = "sphere"
motion = "spin"
contact_radius_mm = 24
friction = 1.7
position_mm = [-55, 20]
load_n = 150
[[contact]]
shape = "sphere"
motion = "partial_slip"
contact_radius_mm = 26
friction = 1.9
tangential_ratio = 0.7
position_mm = [10, 35]
load_n = 200
[[contact]]
shape = "flat_punch"
motion = "slide"
contact_radius_mm = 15
friction = 1.6
position_mm = [62, 0]
load_n = 120
[[contact]]
shape = "cylinder"
motion = "roll"
contact_radius_mm = 11
length_mm = 60
friction = 1.8
direction_deg = 90
tangential_ratio = 0.6
position_mm = [-10, -38]
load_n = 220
)";

SolverPlan plan_of(const Simulator& simulator) {
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.estimator = Estimator::contact;
  plan.uncertainty = true;
  return plan;
}

std::size_t count_of(std::span<const std::uint8_t> status, std::uint8_t bit) {
  std::size_t count = 0;
  for (const std::uint8_t byte : status) count += (byte & bit) != 0 ? 1U : 0U;
  return count;
}

void expect_same_runs(std::span<const ContactRun> actual, std::span<const ContactRun> expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_EQ(actual[i].row, expected[i].row);
    EXPECT_EQ(actual[i].first, expected[i].first);
    EXPECT_EQ(actual[i].end, expected[i].end);
    EXPECT_EQ(actual[i].contact, expected[i].contact);
  }
}

class EveryPath : public OnDevice<Memory> {
 protected:
  [[nodiscard]] static Processor processor(const SolverPlan& plan) {
    return {test_device(), plan, {.memory = GetParam()}};
  }

  /// Solves the frames of the scene, and calls `visit(forces, readings)` for each.
  template <class Visit>
  void solve_all(Processor& solver, Visit visit) const {
    FrameBuffer raw(plan_.sensel_type, plan_.skin.rows, plan_.skin.cols);
    ForceField truth(plan_.skin);
    for (std::uint64_t index = 0; index < simulator_.scene().frames; ++index) {
      simulator_.render(index, raw, truth);
      solver.submit(raw.view());
      visit(solver.receive(), raw.view());
    }
  }

  void expect_host_bits() const {
    Processor solver = processor(plan_);
    solve_all(solver, [&](const ForceFieldView& forces, const FrameView& raw) {
      const ForceField expected = solve_on_host(plan_, raw);
      ASSERT_GT(count_of(expected.status, status::kAmbiguous), 100U);
      expect_same_planes(forces, expected.view());
    });
  }

  const Simulator simulator_{parse_scene(kScene, "scene")};
  SolverPlan plan_ = plan_of(simulator_);
};

TEST_P(EveryPath, EverySourceOfFrictionHasTheBitsOfTheHost) {
  plan_.friction.memory = false;
  expect_host_bits();
  plan_.friction = {.median = 2, .spread = 0.2, .bound = 2.5, .memory = false};
  plan_.segment_point = 0.5;
  expect_host_bits();
  plan_.friction.given = 1.7;
  expect_host_bits();
}

TEST_P(EveryPath, FrictionIsCarriedFromFrameToFrame) {
  SolverPlan direct = plan_;
  direct.estimator = Estimator::direct;
  Processor solver = processor(plan_);
  ContactEstimator estimator(plan_);
  bool any_differs = false;
  solve_all(solver, [&](const ForceFieldView& forces, const FrameView& raw) {
    ForceField expected = solve_on_host(direct, raw);
    estimator.resolve(expected);
    expect_same_bits(forces, expected.view());
    any_differs |= solve_on_host(plan_, raw).normal != expected.normal;
  });
  EXPECT_TRUE(any_differs);  // from frames solved without history
}

TEST_P(EveryPath, ReturnsTheContactsOfTheFrame) {
  Processor solver = processor(plan_);
  EXPECT_EQ(solver.contacts().labels, nullptr);
  solve_all(solver, [&](const ForceFieldView& forces, const FrameView&) {
    ContactLabels found;
    found.find(forces.status, forces.rows, forces.cols);
    ASSERT_NE(solver.contacts().labels, nullptr);
    EXPECT_GT(found.contacts(), 2U);
    expect_same_runs(solver.contacts().labels->runs(), found.runs());
    EXPECT_EQ(solver.contacts().friction.size(), found.contacts());
  });
}

TEST_P(EveryPath, ATrackerFindsTheContactsOfADirectSolveBesideIdleBlocks) {
  plan_.estimator = Estimator::direct;
  Processor solver = processor(plan_);
  EXPECT_EQ(solver.contacts().idle, nullptr);
  ContactTracker tracker(plan_.skin.element_pitch_mm());
  double time_s = 0;
  solve_all(solver, [&](const ForceFieldView& forces, const FrameView&) {
    ContactLabels found;
    found.find(forces.status, forces.rows, forces.cols);
    ASSERT_EQ(solver.contacts().labels, nullptr);
    ASSERT_NE(solver.contacts().idle, nullptr);
    tracker.update(forces, time_s++, solver.contacts());
    EXPECT_GT(found.contacts(), 2U);
    const ForceField larger(forces.rows + 1, forces.cols);
    EXPECT_THROW(ContactTracker(1).update(larger.view(), 0, solver.contacts()), Error);
    expect_same_runs(tracker.labels().runs(), found.runs());
  });
}

TEST_P(EveryPath, RandomFramesHaveTheBitsOfTheHost) {
  for (const SenselType type : {SenselType::u8, SenselType::f32}) {
    SolverPlan plan = full_plan(66, 2 * 41, type, 5);
    plan.estimator = Estimator::contact;
    plan.friction.memory = false;
    Processor solver = processor(plan);
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const RandomFrame frame(plan, 3, seed);
      solver.submit(frame.view());
      expect_same_planes(solver.receive(), solve_on_host(plan, frame.view()).view());
    }
  }
}

TEST_P(EveryPath, AnglesAreThoseOfTheForces) {
  plan_.angles = true;
  Processor solver = processor(plan_);
  std::size_t resolved = 0;
  solve_all(solver, [&](const ForceFieldView& forces, const FrameView&) {
    for (std::size_t i = 0; i < forces.normal.size(); ++i) {
      if ((forces.status[i] & status::kFromNeighbours) == 0) continue;
      ++resolved;
      const double shear = std::hypot(forces.shear_x[i], forces.shear_y[i]);
      ASSERT_NEAR(forces.theta[i], std::atan2(shear, forces.normal[i]), 1e-6);
      ASSERT_NEAR(forces.magnitude[i], std::hypot(shear, forces.normal[i]), 1e-6);
      ASSERT_LE(forces.uncertainty[Uncertainty::theta_low][i], forces.theta[i] + 1e-6F);
      ASSERT_GE(forces.uncertainty[Uncertainty::theta_high][i], forces.theta[i] - 1e-6F);
    }
  });
  EXPECT_GT(resolved, 500U);
}

INSTANTIATE_TEST_SUITE_P(Ways, EveryPath, testing::Values(Memory::shared, Memory::staged),
                         [](const auto& memory) {
                           return memory.param == Memory::shared ? "shared" : "staged";
                         });

TEST(ContactStage, IsNamedAmongTheStages) {
  SolverPlan plan = bare_plan(20, 20, SenselType::u8);
  plan.estimator = Estimator::contact;
  EXPECT_EQ(kernel_stages(plan).back(), "estimate_contacts");
}

}  // namespace
}  // namespace pillarfield
