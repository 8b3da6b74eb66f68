// Moments of off-centre pressure under pillars.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pillarfield/simulator.h"
#include "simulation/closed_form/contact_traction.h"
#include "simulation/indenter/indenter_history.h"

namespace pillarfield {
namespace {

constexpr double kPitch = 1.25;

struct EffectFrame {
  explicit EffectFrame(const Scene& scene)
      : raw(SenselType::f32, scene.skin.rows, scene.skin.cols),
        truth(scene.skin.pillar_rows(), scene.skin.pillar_cols()) {
    Simulator(scene).render(0, raw, truth);
  }
  /// V_n of a pillar, n = 1..4.
  [[nodiscard]] double v(std::uint32_t row, std::uint32_t col, int n) const {
    const std::uint32_t down = n > 2 ? 1 : 0;
    const std::uint32_t right = n == 1 || n == 4 ? 1 : 0;
    return raw.readings<float>()[(2 * row + down) * 2 * truth.cols + 2 * col + right];
  }
  FrameBuffer raw;
  ForceField truth;
};

Scene bare_scene(std::uint32_t pillar_rows, std::uint32_t pillar_cols) {
  Scene scene;
  scene.skin.rows = 2 * pillar_rows;
  scene.skin.cols = 2 * pillar_cols;
  scene.skin.sensel_pitch_mm = kPitch / 2;
  scene.skin.counts_per_newton = 100;
  return scene;
}

ClosedFormContact pressed(ContactShape shape, double radius_mm, double x_mm, double y_mm) {
  ClosedFormContact contact;
  contact.shape = shape;
  contact.contact_radius_mm = radius_mm;
  contact.length_mm = 6.5;
  contact.direction_deg = 33;
  contact.reference_load_n = 5;
  contact.path = {{0, x_mm, y_mm, 5}};
  return contact;
}

PressureMoments moments_under(const ClosedFormContact& contact, std::uint32_t pillars,
                              ForceField& forces) {
  PressureMoments moments(std::size_t{pillars} * pillars);
  add_contact(contact, contact.path.front(), kPitch, forces);
  add_pressure_moments(contact, contact.path.front(), kPitch, pillars, pillars, moments);
  return moments;
}

double axis_mm(std::size_t index, std::uint32_t pillars) {
  return (static_cast<double>(index) - (pillars - 1) / 2.0) * kPitch;
}

/// The moment of all pressure about the origin is that of the load in the contact's centre.
TEST(PressureMoments, AddUpToTheMomentOfTheLoad) {
  constexpr std::uint32_t kPillars = 13;
  for (const auto shape :
       {ContactShape::sphere, ContactShape::flat_punch, ContactShape::cylinder}) {
    for (const double radius : {0.3, 1.0, 3.7}) {
      const ClosedFormContact contact = pressed(shape, radius, 0.41, -0.83);
      ForceField forces(kPillars, kPillars);
      const PressureMoments moments = moments_under(contact, kPillars, forces);
      double x = 0;
      double y = 0;
      for (std::size_t i = 0; i < moments.x.size(); ++i) {
        x += forces.normal[i] * axis_mm(i % kPillars, kPillars) + moments.x[i];
        y += -forces.normal[i] * axis_mm(i / kPillars, kPillars) + moments.y[i];
      }
      EXPECT_NEAR(x, 5 * 0.41, 5e-4 * kPitch) << int(shape) << " " << radius;
      EXPECT_NEAR(y, 5 * -0.83, 5e-4 * kPitch) << int(shape) << " " << radius;
    }
  }
}

/// Hertz's pressure summed over 500 x 500 points of a pillar.
TEST(PressureMoments, AreTheIntegralsOfHertzsPressure) {
  constexpr std::uint32_t kPillars = 9;
  constexpr int kPoints = 500;
  const ClosedFormContact ball = pressed(ContactShape::sphere, 3, 0.2, 0.5);
  ForceField forces(kPillars, kPillars);
  const PressureMoments moments = moments_under(ball, kPillars, forces);
  for (const std::size_t pillar : {40U, 41U, 31U, 23U, 60U}) {
    const double x0 = axis_mm(pillar % kPillars, kPillars);
    const double y0 = -axis_mm(pillar / kPillars, kPillars);
    double x = 0;
    double y = 0;
    for (int i = 0; i < kPoints; ++i) {
      for (int j = 0; j < kPoints; ++j) {
        const double dx = ((i + 0.5) / kPoints - 0.5) * kPitch;
        const double dy = ((j + 0.5) / kPoints - 0.5) * kPitch;
        const double r = std::hypot(x0 + dx - 0.2, y0 + dy - 0.5) / 3;
        const double p = r < 1 ? 3 * 5 / (2 * std::numbers::pi * 9) * std::sqrt(1 - r * r) : 0;
        x += p * dx;
        y += p * dy;
      }
    }
    const double area = kPitch * kPitch / kPoints / kPoints;
    EXPECT_NEAR(moments.x[pillar], x * area, 2e-5) << pillar;
    EXPECT_NEAR(moments.y[pillar], y * area, 2e-5) << pillar;
  }
}

/// Its pressure is even on each of 4 x 4 cells, which lacks 1/16 of the moment of an even gradient.
TEST(PressureMoments, OfAnIndenterAreThoseOfItsClosedForm) {
  Scene scene = bare_scene(15, 15);
  Indenter ball;
  ball.shape = IndenterShape::sphere;
  ball.radius_mm = 20;
  ball.friction = 0;
  ball.path = {{0, 0.3, -0.2, 0, 5}};
  scene.indenters = {ball};
  IndenterHistory history(scene, 0);
  // Hertz: a³ = 3PR/(4E*), E* = 4E/3.
  const double radius = std::cbrt(3 * 5 * 20 / (4 * (4.0 / 3)));
  ForceField forces(15, 15);
  const PressureMoments moments =
      moments_under(pressed(ContactShape::sphere, radius, 0.3, -0.2), 15, forces);
  const double largest = std::ranges::max(moments.x);
  EXPECT_GT(largest, 0.005);
  for (const IndenterForce& force : *history.forces(0)) {
    EXPECT_NEAR(force.moment_x, moments.x[force.pillar], 0.1 * largest) << force.pillar;
    EXPECT_NEAR(force.moment_y, moments.y[force.pillar], 0.1 * largest) << force.pillar;
  }
}

/// Pressure with an even gradient g: the moment is g · pitch⁴/12. At (x, y) from the middle of a
/// large ball g is −p₀ (x, y)/a² / sqrt(1 − (x² + y²)/a²).
TEST(PillarArm, ReadsAPressureGradientAsShearTowardsTheHigherPressure) {
  Scene scene = bare_scene(41, 41);
  ClosedFormContact ball = pressed(ContactShape::sphere, 200, -60, 25);
  ball.reference_load_n = 40000;
  ball.path.front().load_n = 40000;
  scene.load = std::vector{ball};
  const EffectFrame centred(scene);
  scene.sensor.effects.arm_mm = 0.25;
  const EffectFrame tilted(scene);
  EXPECT_EQ(centred.truth.shear_x, tilted.truth.shear_x);
  const double p0 = 3 * 40000 / (2 * std::numbers::pi * 200 * 200);
  const double fall = p0 / (200.0 * 200) / std::sqrt(1 - (60.0 * 60 + 25 * 25) / (200 * 200));
  const double counts = 4 * 100 / std::numbers::sqrt2 * std::pow(kPitch, 4) / 12 / 0.25;
  const auto sum = [&](int a, int b) { return tilted.v(20, 20, a) + tilted.v(20, 20, b); };
  EXPECT_NEAR(sum(1, 4) - sum(2, 3), -60 * fall * counts, 2e-3);
  EXPECT_NEAR(sum(1, 2) - sum(3, 4), 25 * fall * counts, 2e-3);
  EXPECT_NEAR(sum(1, 3), centred.v(20, 20, 1) + centred.v(20, 20, 3), 1e-3);
}

}  // namespace
}  // namespace pillarfield
