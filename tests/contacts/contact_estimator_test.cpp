// The estimator `contact` on boundary-element contacts down to a fingertip's size: its error
// against the paper's midpoint, the pillars it must not change, and named hard cases.

#include "contacts/estimator/contact_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "dragged_indenters.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

struct Case {
  const char* name;
  Scene (*motion)(const Indenter&, double);
  Indenter (*indenter)();
  double friction;
};

constexpr Case kCases[] = {
    {"fingertip dragged", dragged, fingertip, 1.2}, {"fingertip dragged", dragged, fingertip, 1.6},
    {"fingertip dragged", dragged, fingertip, 2.2}, {"fingertip turned", turned, fingertip, 1.6},
    {"fingertip turned", turned, fingertip, 2.2},   {"ball dragged", dragged, ball, 1.6},
    {"ball dragged", dragged, ball, 2.2},           {"ball turned", turned, ball, 1.6},
    {"punch dragged", dragged, punch, 1.6},         {"punch turned", turned, punch, 2.2},
};

/// The error relative to the paper's midpoint of each recording, and what the stated deviations
/// hold of all of them.
TEST(ContactEstimator, BeatsThePapersMidpointAndHoldsTheTruth) {
  Errors all;
  for (const Case& each : kCases) {
    SCOPED_TRACE(std::string(each.name) + " at " + std::to_string(each.friction));
    const Simulator simulator(each.motion(each.indenter(), each.friction));
    const Errors paper = paper_errors(simulator);
    const Errors contact = contact_errors(simulator);
    ASSERT_GT(contact.pillars, 30);
    EXPECT_LT(contact.rms(), 0.45 * paper.rms());
    all += contact;
  }
  EXPECT_GT(all.coverage(), 0.93);
  EXPECT_LT(all.rms(), 2);
}

/// Frictions that the prior does not expect, and that few pillars show.
TEST(ContactEstimator, HoldsTheTruthAtHighFrictions) {
  for (const double friction : {4.5, 6.0}) {
    Errors all;
    for (const auto indenter : {fingertip, ball, punch}) {
      all += contact_errors(Simulator(dragged(indenter(), friction)));
    }
    for (const double held : all.between) EXPECT_GT(held, 0.9 * all.pillars) << friction;
  }
}

TEST(ContactEstimator, AGivenFrictionHelpsAndALooseBoundDoesNotHarm) {
  const Simulator scene(dragged(ball(), 1.8));
  const double alone = contact_errors(scene).rms();
  FrictionKnowledge given;
  given.given = 1.8;
  EXPECT_LT(contact_errors(scene, given).rms(), 1.02 * alone);
  for (const double bound : {2.5, 4.0, 8.0}) {
    FrictionKnowledge bounded;
    bounded.bound = bound;
    EXPECT_LT(contact_errors(scene, bounded).rms(), 1.02 * alone) << bound;
  }
}

/// Pressed and then slid: most ambiguous pillars were determined while the body only pressed.
TEST(ContactEstimator, RemembersThePressureOfAContact) {
  FrictionKnowledge unrelated;
  unrelated.memory = false;
  for (const double friction : {2.2, 3.0}) {
    const Simulator turning(turned(ball(), friction));
    EXPECT_LT(contact_errors(turning).rms(), 0.75 * contact_errors(turning, unrelated).rms());
    const Simulator sliding(dragged(punch(), friction));
    EXPECT_LT(contact_errors(sliding).rms(), 0.88 * contact_errors(sliding, unrelated).rms());
  }
}

/// Pressed, dragged to about a fifth of the load that slides, at rest there, and dragged on.
TEST(ContactEstimator, BoundsTheFrictionBeforeTheOnsetOfSlipAndReportsItAfter) {
  constexpr std::uint32_t kSticks = 45;  // frames
  int bounds = 0;
  int wrong = 0;
  for (const auto indenter : {fingertip, ball, punch}) {
    for (const double friction : {0.6, 1.2}) {
      Scene scene = dragged(indenter(), friction);
      scene.rate_hz = 30;
      scene.frames = 90;
      scene.indenters[0].path = {{0.0, -3, 0.5, 0, 6},
                                 {0.2, -3, 0.5, 0, 14},
                                 {1.0, -3 + 0.6 * friction, 0.5, 0, 14},
                                 {1.5, -3 + 0.6 * friction, 0.5, 0, 14},
                                 {2.8, -3 + 8 * friction, 0.5, 0, 14}};
      const Simulator simulator(scene);
      const SolverPlan direct = plan_of(scene, Estimator::direct);
      ContactEstimator estimator(plan_of(scene, Estimator::contact));
      FrameBuffer raw(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
      ForceField truth(26, 26);
      for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
        simulator.render(frame, raw, truth);
        ForceField field = solve_on_host(direct, raw.view());
        estimator.resolve(field);
        const ContactFriction& found = estimator.friction()[0];
        if (found.source == FrictionSource::at_least) {
          ++bounds;
          wrong += found.least > friction;
        } else if (found.source != FrictionSource::prior) {
          EXPECT_GT(frame, kSticks) << friction;
          EXPECT_NEAR(found.median, friction, 0.1 * friction) << frame;
        }
      }
      EXPECT_NE(estimator.friction()[0].source, FrictionSource::prior) << friction;
    }
  }
  EXPECT_GT(bounds, 100);
  EXPECT_LE(wrong, bounds / 20);
}

/// Forces before the contact lifted off say nothing of the next contact.
TEST(ContactEstimator, ForgetsAContactThatLiftsOff) {
  const Simulator simulator(turned(ball(), 2.2));
  const SolverPlan direct = plan_of(simulator.scene(), Estimator::direct);
  const auto frame = [&](std::uint32_t index) {
    FrameBuffer raw(simulator.sensel_type(), 52, 52);
    ForceField truth(26, 26);
    simulator.render(index, raw, truth);
    return solve_on_host(direct, raw.view());
  };
  const auto last_of = [&](const std::vector<ForceField>& fields) {
    ContactEstimator estimator(plan_of(simulator.scene(), Estimator::contact));
    ForceField last;
    for (const ForceField& field : fields) {
      last = field;
      estimator.resolve(last);
    }
    return last.normal;
  };
  const ForceField pressed = frame(2);
  const ForceField turned_far = frame(6);
  ForceField idle = pressed;
  for (auto* plane : {&idle.shear_x, &idle.shear_y, &idle.normal}) {
    std::ranges::fill(*plane, 0.0F);
  }
  std::ranges::fill(idle.status, std::uint8_t{0});
  EXPECT_NE(last_of({pressed, turned_far}), last_of({turned_far}));
  EXPECT_EQ(last_of({pressed, idle, turned_far}), last_of({turned_far}));
}

/// A single frame of a ball in partial slip, as a closed form: most slipping pillars are ambiguous,
/// and the pressure regression adds what the ratios of determined pillars lack.
TEST(ContactEstimator, ReadsTheShapeOfThePressureUnderASmoothIndenter) {
  for (const double friction : {1.6, 1.8, 2.2}) {
    for (const double direction_deg : {0.0, 3.0, 90.0, 183.0}) {
      Scene scene = dragged(ball(), friction);
      scene.skin.counts_per_newton = 700;
      scene.frames = 1;
      ClosedFormContact contact;
      contact.motion = ContactMotion::partial_slip;
      contact.contact_radius_mm = 12;
      contact.reference_load_n = 40;
      contact.friction = friction;
      contact.tangential_ratio = 0.7;
      contact.direction_deg = direction_deg;
      contact.path = {{0, 0.4, -0.3, 40}};
      scene.indenters.clear();
      scene.load = std::vector<ClosedFormContact>{contact};
      const Simulator simulator(scene);
      const Errors found = contact_errors(simulator);
      ASSERT_GT(found.pillars, 30);
      EXPECT_LT(found.rms(), 0.25 * paper_errors(simulator).rms())
          << friction << " at " << direction_deg;
    }
  }
}

class OneFrame : public testing::Test {
 protected:
  OneFrame() : scene_(dragged(fingertip(), 1.8)), simulator_(scene_) {
    FrameBuffer raw(simulator_.sensel_type(), scene_.skin.rows, scene_.skin.cols);
    ForceField truth(26, 26);
    simulator_.render(6, raw, truth);
    direct_ = solve_on_host(plan_of(scene_, Estimator::direct), raw.view());
    contact_ = solve_on_host(plan_of(scene_, Estimator::contact), raw.view());
  }

  Scene scene_;
  Simulator simulator_;
  ForceField direct_;
  ForceField contact_;
};

TEST_F(OneFrame, ChangesNothingButAmbiguousPillars) {
  int changed = 0;
  for (std::size_t i = 0; i < direct_.elements(); ++i) {
    if (is_ambiguous_pair(direct_.status[i])) {
      changed += contact_.normal[i] != direct_.normal[i];
      continue;
    }
    EXPECT_EQ(contact_.normal[i], direct_.normal[i]);
    EXPECT_EQ(contact_.shear_x[i], direct_.shear_x[i]);
    EXPECT_EQ(contact_.shear_y[i], direct_.shear_y[i]);
    EXPECT_EQ(contact_.status[i], direct_.status[i]);
  }
  EXPECT_GE(changed, 10);
}

/// Forces of any size: the same scene in other units.
TEST_F(OneFrame, ScalesWithTheForces) {
  ForceField scaled = direct_;
  constexpr float kScale = 1024;
  for (auto* plane : {&scaled.shear_x, &scaled.shear_y, &scaled.normal}) {
    for (float& value : *plane) value *= kScale;
  }
  SolverPlan plan = plan_of(scene_, Estimator::contact);
  plan.skin.counts_per_newton /= kScale;
  ContactEstimator(plan).resolve(scaled);
  for (std::size_t i = 0; i < scaled.elements(); ++i) {
    EXPECT_NEAR(scaled.normal[i], kScale * contact_.normal[i], 1e-3 * kScale * contact_.normal[i]);
  }
}

TEST_F(OneFrame, StaysFiniteOnAnyPlanes) {
  const float strange[] = {0,
                           -1,
                           1e-38F,
                           1e30F,
                           std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN()};
  ContactEstimator estimator(plan_of(scene_, Estimator::contact));
  for (const float value : strange) {
    ForceField broken = direct_;
    for (std::size_t i = 0; i < broken.elements(); i += 3) {
      broken.normal[i] = value;
      broken.shear_x[(i + 1) % broken.elements()] = value;
      broken.status[i] = static_cast<std::uint8_t>(i);
    }
    estimator.resolve(broken);
    // Later frames are unaffected.
    ForceField next = direct_;
    estimator.resolve(next);
    for (const float normal : next.normal) EXPECT_TRUE(std::isfinite(normal));
    for (const ContactFriction& each : estimator.friction()) {
      EXPECT_TRUE(std::isfinite(each.median) && std::isfinite(each.spread));
    }
  }
}

/// An isolated pillar: only the prior and the lower bound of its own readings constrain friction.
TEST(ContactEstimator, OnePillarHasThePriorsForce) {
  SolverPlan plan;
  plan.skin.rows = plan.skin.cols = 10;
  plan.skin.counts_per_newton = 1;
  plan.skin.threshold_counts = 2;
  plan.sensel_type = SenselType::f32;
  plan.noise_counts = 0.5;
  plan.estimator = Estimator::contact;
  std::vector<float> readings(100, 0);
  // It slips to the right at a friction of 1.8 with a normal force of 40 counts.
  const auto reading = static_cast<float>(40 * (1 + 1.8 / std::sqrt(2.0)));
  readings[4 * 10 + 5] = readings[5 * 10 + 5] = reading;
  const ForceField field = solve_on_host(plan, {readings.data(), SenselType::f32, 10, 10, 10});
  EXPECT_GT(field.normal[12], 0.75 * reading / 2);
  EXPECT_LT(field.normal[12], 1.02 * reading / 2);
}

TEST(ContactEstimator, NothingIsAContactOnAnIdleSkin) {
  SolverPlan plan;
  plan.skin.rows = plan.skin.cols = 10;
  ContactEstimator estimator(plan);
  ForceField field(5, 5);
  for (int frame = 0; frame < 3; ++frame) estimator.resolve(field);
  EXPECT_EQ(estimator.contacts().contacts(), 0U);
  EXPECT_TRUE(estimator.friction().empty());
}

}  // namespace
}  // namespace pillarfield
