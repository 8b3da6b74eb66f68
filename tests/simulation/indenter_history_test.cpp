#include "simulation/indenter/indenter_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pillarfield/error.h"
#include "pillarfield/simulator.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

using core_test::message_of;

/// A skin of 26 x 26 pillars with one indenter.
Scene scene_of(const Indenter& indenter, std::uint32_t frames = 8) {
  Scene scene;
  scene.skin.rows = 52;
  scene.skin.cols = 52;
  scene.frames = frames;
  scene.rate_hz = 10;
  scene.indenters = {indenter};
  return scene;
}

/// A fingertip, longer than wide, that presses, is dragged, turned and pulled back.
Indenter fingertip() {
  Indenter indenter;
  indenter.shape = IndenterShape::ellipsoid;
  indenter.radii_mm = {14, 9, 8};
  indenter.friction = 0.9;
  indenter.path = {{0, -1, 0.5, 10, 4},
                   {0.2, -1, 0.5, 10, 9},
                   {0.4, -0.2, 0.7, 10, 9},
                   {0.5, 1.8, 1, 15, 8},
                   {0.7, 1.2, 0.5, -5, 6}};
  return indenter;
}

ForceField truth_of(const Simulator& simulator, std::uint64_t index) {
  const Skin& skin = simulator.scene().skin;
  FrameBuffer raw(simulator.sensel_type(), skin.rows, skin.cols);
  ForceField truth(skin.pillar_rows(), skin.pillar_cols());
  simulator.render(index, raw, truth);
  return truth;
}

struct Resultant {
  double shear_x = 0;
  double shear_y = 0;
  double normal = 0;
};

Resultant resultant(const IndenterForces& forces) {
  Resultant sum;
  for (const IndenterForce& force : forces) {
    sum.shear_x += force.shear_x;
    sum.shear_y += force.shear_y;
    sum.normal += force.normal;
  }
  return sum;
}

/// An indenter that is long in x lies, turned counter-clockwise, along a line that rises to the
/// right; and being turned on the skin it turns the skin with it.
TEST(IndenterHistory, TurnsCounterClockwise) {
  for (const double angle_deg : {30.0, -30.0}) {
    Indenter indenter = fingertip();
    indenter.path = {{0, 0, 0, angle_deg, 9}, {0.1, 0, 0, angle_deg + 4, 9}};
    const Simulator simulator(scene_of(indenter, 2));
    const ForceField pressed = truth_of(simulator, 0);
    const ForceField turned = truth_of(simulator, 1);
    double product = 0;
    double squares = 0;
    double torque = 0;
    for (std::size_t i = 0; i < pressed.elements(); ++i) {
      const std::size_t row = i / pressed.cols;
      const double x = static_cast<double>(i % pressed.cols) - 12.5;
      const double y = 12.5 - static_cast<double>(row);
      product += pressed.normal[i] * x * y;
      squares += pressed.normal[i] * x * x;
      torque += x * turned.shear_y[i] - y * turned.shear_x[i];
    }
    EXPECT_GT(product * angle_deg, 0);
    EXPECT_GT(std::abs(product), 0.1 * squares);
    EXPECT_GT(torque, 0);
  }
}

TEST(IndenterHistory, CarriesTheLoadAndNeverMoreShearThanFriction) {
  const Indenter indenter = fingertip();
  IndenterHistory history(scene_of(indenter), 0);
  for (std::uint64_t frame = 0; frame < 9; ++frame) {
    const auto forces = history.forces(frame);
    const double load = state_at(indenter, static_cast<double>(frame) / 10).load_n;
    EXPECT_NEAR(resultant(*forces).normal, load, 1e-12 * load) << frame;
    for (const IndenterForce& force : *forces) {
      ASSERT_GT(force.normal, 0);
      ASSERT_LE(std::hypot(force.shear_x, force.shear_y),
                indenter.friction * force.normal * (1 + 1e-9));
    }
  }
}

TEST(IndenterHistory, PressingAloneMakesNoShear) {
  Indenter indenter = fingertip();
  indenter.path = {{0, 0, 0, 0, 2}, {0.3, 0, 0, 0, 9}};
  IndenterHistory history(scene_of(indenter), 0);
  for (std::uint64_t frame = 0; frame < 5; ++frame) {
    for (const IndenterForce& force : *history.forces(frame)) {
      ASSERT_EQ(force.shear_x, 0);
      ASSERT_EQ(force.shear_y, 0);
    }
  }
}

/// The signs of the project: an indenter that goes right pushes the skin to the right, one that
/// turns counter-clockwise turns the skin so.
TEST(IndenterHistory, ShearFollowsTheIndenter) {
  Indenter indenter;
  indenter.radius_mm = 15;
  indenter.friction = 0.7;
  indenter.path = {{0, 0, 0, 0, 6}, {0.1, 3, 4, 0, 6}};
  const Scene scene = scene_of(indenter);
  IndenterHistory slid(scene, 0);
  const Resultant sum = resultant(*slid.forces(1));
  EXPECT_NEAR(sum.shear_x, 0.6 * 0.7 * 6, 0.03);
  EXPECT_NEAR(sum.shear_y, 0.8 * 0.7 * 6, 0.03);
  indenter.path = {{0, 0, 0, 0, 6}, {0.1, 0, 0, 60, 6}};
  IndenterHistory turned(scene_of(indenter), 0);
  double torque = 0;
  for (const IndenterForce& force : *turned.forces(1)) {
    const auto row = force.pillar / 26;
    const double x = static_cast<double>(force.pillar % 26) - 12.5;
    const double y = 12.5 - static_cast<double>(row);
    torque += (x * force.shear_y - y * force.shear_x) * scene.skin.pillar_pitch_mm();
  }
  // (3π/16) µPa of a ball that turns all over; a from Hertz's law.
  const double contact_mm = std::cbrt(3 * 6.0 * 15 / (4 * 4.0 / 3));
  EXPECT_NEAR(torque, 3 * std::numbers::pi / 16 * 0.7 * 6 * contact_mm, 0.3);
}

TEST(IndenterHistory, TurningTheWholeSceneTurnsTheTruth) {
  const Indenter indenter = fingertip();
  Indenter turned = indenter;
  for (IndenterKey& key : turned.path) {
    key = {key.time_s, -key.y_mm, key.x_mm, key.angle_deg + 90, key.load_n};
  }
  const Simulator upright(scene_of(indenter));
  const Simulator lying(scene_of(turned));
  for (const std::uint64_t frame : {0U, 3U, 5U, 7U}) {
    const ForceField a = truth_of(upright, frame);
    const ForceField b = truth_of(lying, frame);
    double most = 0;
    for (std::uint32_t row = 0; row < 26; ++row) {
      for (std::uint32_t col = 0; col < 26; ++col) {
        // Counter-clockwise: what was at (x, y) is at (−y, x).
        const std::size_t from = row * 26 + col;
        const std::size_t to = (25 - col) * 26 + row;
        most = std::max({most, std::abs(double{a.normal[from]} - double{b.normal[to]}),
                         std::abs(double{a.shear_x[from]} - double{b.shear_y[to]}),
                         std::abs(double{a.shear_y[from]} + double{b.shear_x[to]})});
      }
    }
    EXPECT_LT(most, 2e-5) << "newtons, frame " << frame;
  }
}

TEST(IndenterHistory, NothingChangesAfterThePathsEnd) {
  IndenterHistory history(scene_of(fingertip()), 0);
  const auto last = history.forces(7);
  EXPECT_EQ(history.forces(8), last);
  EXPECT_EQ(history.forces(99'999'999), last);
}

TEST(IndenterHistory, AnIndenterThatStandsStillKeepsItsShear) {
  Indenter indenter = fingertip();
  indenter.path = {{0, 0, 0, 0, 6}, {0.1, 0.3, 0, 0, 6}, {0.5, 0.3, 0, 0, 6}};
  IndenterHistory history(scene_of(indenter), 0);
  const auto moved = history.forces(1);
  EXPECT_GT(resultant(*moved).shear_x, 0.5);
  EXPECT_EQ(history.forces(3), moved);
}

TEST(IndenterHistory, LiftingForgetsTheShear) {
  Indenter indenter = fingertip();
  indenter.path = {{0, 0, 0, 0, 6}, {0.2, 1, 0, 0, 6}, {0.3, 1, 0, 0, 0}, {0.4, 1, 0, 0, 6}};
  IndenterHistory history(scene_of(indenter), 0);
  EXPECT_GT(resultant(*history.forces(2)).shear_x, 1);
  EXPECT_TRUE(history.forces(3)->empty());
  EXPECT_EQ(resultant(*history.forces(4)).shear_x, 0);
  EXPECT_NEAR(resultant(*history.forces(4)).normal, 6, 1e-11);
}

TEST(IndenterHistory, WhatLiesOutsideTheSkinIsLost) {
  Indenter indenter = fingertip();
  indenter.shape = IndenterShape::sphere;
  const double edge_mm = 13 * Skin().pillar_pitch_mm();
  indenter.path = {{0, edge_mm, 0, 0, 6}};
  IndenterHistory at_edge(scene_of(indenter), 0);
  EXPECT_NEAR(resultant(*at_edge.forces(0)).normal, 3, 1e-3);
  indenter.path = {{0, 1000, 0, 0, 6}};
  IndenterHistory beyond(scene_of(indenter), 0);
  EXPECT_TRUE(beyond.forces(0)->empty());
}

/// Friction that varies: in full sliding it shows on every pillar, within its bounds.
TEST(IndenterHistory, FrictionVariesOverTheIndenter) {
  Indenter indenter;
  indenter.shape = IndenterShape::punch;
  indenter.radius_mm = 12;
  indenter.edge_radius_mm = 3;
  indenter.friction = 1;
  indenter.friction_variation = 0.4;
  indenter.path = {{0, 0, 0, 0, 20}, {0.1, 40, 0, 0, 20}};
  Scene scene = scene_of(indenter);
  scene.skin.cols = 140;
  IndenterHistory history(scene, 0);
  double least = 9;
  double most = 0;
  for (const IndenterForce& force : *history.forces(1)) {
    const double ratio = std::hypot(force.shear_x, force.shear_y) / force.normal;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  EXPECT_GE(least, 0.6 - 1e-9);
  EXPECT_LT(least, 0.85);
  EXPECT_GT(most, 1.15);
  EXPECT_LE(most, 1.4 + 1e-9);
}

TEST(IndenterHistory, RoughnessIsTheSeeds) {
  Indenter indenter;
  indenter.radius_mm = 20;
  indenter.roughness_um = 60;
  indenter.path = {{0, 0, 0, 0, 10}};
  Scene scene = scene_of(indenter);
  const auto rough = IndenterHistory(scene, 0).forces(0);
  const auto again = IndenterHistory(scene, 0).forces(0);
  scene.seed = 2;
  const auto other = IndenterHistory(scene, 0).forces(0);
  scene.indenters[0].roughness_um = 0;
  const auto smooth = IndenterHistory(scene, 0).forces(0);
  const auto highest = [](const IndenterForces& forces) {
    return std::ranges::max(forces, {}, &IndenterForce::normal).normal;
  };
  EXPECT_EQ(highest(*rough), highest(*again));
  EXPECT_NE(highest(*rough), highest(*other));
  EXPECT_GT(highest(*rough), 1.2 * highest(*smooth));
  EXPECT_NEAR(resultant(*rough).normal, 10, 1e-10);
}

TEST(IndenterHistory, RefusesWhatItCannotSolve) {
  Indenter wide;
  wide.radius_mm = 9000;
  wide.path = {{0, 0, 0, 0, 1e5}};
  EXPECT_EQ(
      message_of([&] { static_cast<void>(IndenterHistory(scene_of(wide), 0).forces(0)); }),
      "indenter 1 at 0 s: its contact is more than 128 pillars wide; lower its load or make it "
      "smaller");
  Indenter tiny;
  tiny.radius_mm = 0.02;
  tiny.path = {{0, 0, 0, 0, 1}};
  EXPECT_EQ(
      message_of([&] { static_cast<void>(IndenterHistory(scene_of(tiny), 0).forces(0)); }),
      "indenter 1 at 0 s: it lies between the cells of 0.3162 mm that bear the load; make the "
      "indenter larger than a cell");
  Indenter fast = fingertip();
  fast.path = {{0, 0, 0, 0, 6}, {0.1, 1, 0, 0, 6}, {0.2, 900, 0, 0, 6}};
  IndenterHistory history(scene_of(fast), 0);
  EXPECT_NO_THROW(static_cast<void>(history.forces(1)));
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(message_of([&] { static_cast<void>(history.forces(2)); }),
              "indenter 1 at 0.2 s: it moves 899 mm in one step; give it more substeps, or "
              "withdraw it in "
              "between");
  }
}

/// A path in substeps is the path in as many frames.
TEST(IndenterHistory, SubstepsAreStepsBetweenFrames) {
  Indenter indenter = fingertip();
  indenter.substeps = 2;
  Scene coarse = scene_of(indenter);
  indenter.substeps = 1;
  Scene fine = scene_of(indenter, 16);
  fine.rate_hz = 20;
  const auto a = IndenterHistory(coarse, 0).forces(5);
  const auto b = IndenterHistory(fine, 0).forces(10);
  ASSERT_EQ(a->size(), b->size());
  for (std::size_t i = 0; i < a->size(); ++i) {
    ASSERT_NEAR((*a)[i].shear_x, (*b)[i].shear_x, 1e-12);
    ASSERT_NEAR((*a)[i].normal, (*b)[i].normal, 1e-12);
  }
}

TEST(IndenterHistory, IndentersAddToContacts) {
  Scene scene = scene_of(fingertip());
  ClosedFormContact ball;
  ball.contact_radius_mm = 3;
  ball.path = {{0, 10, 10, 2}};
  scene.load = std::vector<ClosedFormContact>{ball};
  const ForceField both = truth_of(Simulator(scene), 0);
  double sum = 0;
  for (const float normal : both.normal) sum += double{normal};
  EXPECT_NEAR(sum, 6, 1e-5);
}

}  // namespace
}  // namespace pillarfield
