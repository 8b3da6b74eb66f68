// Contacts resolved in parallel on a sensor whose pillars lean: each pillar's lean depends on
// pillars of other contacts. The same file is a program of its own under ThreadSanitizer.

#include <gtest/gtest.h>

#include <random>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kRows = 60;
constexpr std::uint32_t kCols = 79;
constexpr std::uint32_t kPeriod = 5;

SolverPlan leaning_plan() {
  SolverPlan plan;
  plan.skin.rows = 2 * kRows;
  plan.skin.cols = 2 * kCols;
  plan.skin.counts_per_newton = 100;
  plan.noise_counts = 0.5;
  plan.estimator = Estimator::contact;
  plan.uncertainty = true;
  plan.calibration.effects.arm_mm = 0.3;
  return plan;
}

/// Squares of four by four pillars, one idle pillar apart, of which most are ambiguous.
ForceField squares(unsigned seed) {
  ForceField field(kRows, kCols);
  for (auto& plane : field.uncertainty) plane.resize(field.elements());
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> part(0, 1);
  for (std::size_t i = 0; i < field.elements(); ++i) {
    if (i / kCols % kPeriod == 0 || i % kCols % kPeriod == 0) continue;
    const bool is_pair = random() % 4 != 0;
    field.normal[i] = 0.2F + part(random);
    field.shear_x[i] = (is_pair ? 1.5F : 0.5F) * field.normal[i];
    field.shear_y[i] = 0.2F * part(random);
    field.status[i] = is_pair ? 9 | status::kAmbiguous : 15;
  }
  return field;
}

TEST(ContactThreads, GiveTheSameBitsToContactsOneIdlePillarApart) {
  const SolverPlan plan = leaning_plan();
  ContactEstimator alone(plan, 1);
  ContactEstimator four(plan, 4);
  for (unsigned frame = 0; frame < 20; ++frame) {
    const ForceField direct = squares(frame);
    ForceField one = direct;
    ForceField shared = direct;
    alone.resolve(one);
    four.resolve(shared);
    ASSERT_NE(one.normal, direct.normal);
    ASSERT_EQ(one.normal, shared.normal) << frame;
    ASSERT_EQ(one.shear_x, shared.shear_x) << frame;
    ASSERT_EQ(one.uncertainty[Uncertainty::normal], shared.uncertainty[Uncertainty::normal]);
  }
}

}  // namespace
}  // namespace pillarfield
