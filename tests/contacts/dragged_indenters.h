#pragma once

// Boundary-element indenters that are dragged or turned on a skin, and the errors of estimates of
// its ambiguous pillars.

#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/component_ends.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// An indenter on 26 x 26 pillars that is pressed, dragged until it slides, and dragged another
/// way.
inline Scene dragged(const Indenter& shape, double friction) {
  Scene scene;
  scene.skin.rows = 52;
  scene.skin.cols = 52;
  scene.skin.threshold_counts = 2;
  scene.skin.counts_per_newton = 160;
  scene.sensor.noise_counts = 0.5;
  scene.frames = 12;
  scene.rate_hz = 10;
  scene.modulus_kpa = 400;
  Indenter indenter = shape;
  indenter.friction = friction;
  indenter.path = {{0.0, -1, 0.5, 0, 6},
                   {0.2, -1, 0.5, 0, 14},
                   {0.6, 0.4 * friction, 1, 5, 14},
                   {0.8, 3, 1.3, 5, 16},
                   {1.1, 3.5, -2, 5, 12}};
  scene.indenters = {indenter};
  return scene;
}

/// An indenter that is pressed and then turned, there and back.
inline Scene turned(const Indenter& shape, double friction) {
  Scene scene = dragged(shape, friction);
  scene.indenters[0].path = {
      {0.0, 0, 0, 0, 6}, {0.2, 0, 0, 0, 14}, {0.7, 0, 0, 40, 14}, {1.1, 0, 0, 10, 14}};
  return scene;
}

inline Indenter fingertip() {
  Indenter indenter;
  indenter.shape = IndenterShape::ellipsoid;
  indenter.radii_mm = {14, 9, 8};
  return indenter;
}

inline Indenter ball() {
  Indenter indenter;
  indenter.radius_mm = 14;
  return indenter;
}

inline Indenter punch() {
  Indenter indenter;
  indenter.shape = IndenterShape::punch;
  indenter.radius_mm = 6;
  indenter.edge_radius_mm = 2;
  return indenter;
}

inline SolverPlan plan_of(const Scene& scene, Estimator estimator) {
  SolverPlan plan;
  plan.calibration.effects = scene.sensor.effects;
  if (const double gains = scene.sensor.gain_spread; gains > 0) {
    plan.calibration.effects.residual = {gains, 0};  // Nothing calibrates them.
  }
  plan.skin = scene.skin;
  plan.sensel_type = SenselType::f32;
  plan.estimator = estimator;
  plan.noise_counts = scene.sensor.noise_counts;
  plan.uncertainty = estimator != Estimator::paper;
  return plan;
}

inline bool is_ambiguous_pair(std::uint8_t bits) { return region_of(bits) == Region::three; }

/// Errors over the pillars of region 3 of a recording.
struct Errors {
  double squares = 0;  ///< of the force vector, counts²
  double held = 0;     ///< true normal forces within 1.96 deviations
  double pillars = 0;
  std::array<double, 3> between{};  ///< true components between their component_ends()

  Errors& operator+=(const Errors& other) {
    squares += other.squares;
    held += other.held;
    pillars += other.pillars;
    for (std::size_t k = 0; k < between.size(); ++k) between[k] += other.between[k];
    return *this;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / pillars); }
  [[nodiscard]] double coverage() const { return held / pillars; }
};

using Solve = std::function<ForceField(const FrameView&)>;

inline Errors errors_of(const Simulator& simulator, const Solve& solve,
                        const std::optional<double>& direct_point = {}) {
  const Scene& scene = simulator.scene();
  FrameBuffer raw(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  Errors errors;
  const double counts = scene.skin.counts_per_newton;
  for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
    simulator.render(frame, raw, truth);
    const ForceField solved = solve(raw.view());
    for (std::size_t i = 0; i < solved.elements(); ++i) {
      if (!is_ambiguous_pair(solved.status[i])) continue;
      const double x = solved.shear_x[i] - truth.shear_x[i];
      const double y = solved.shear_y[i] - truth.shear_y[i];
      const double normal = solved.normal[i] - truth.normal[i];
      errors.squares += counts * counts * (x * x + y * y + normal * normal);
      errors.pillars += 1;
      const auto& deviation = solved.uncertainty[Uncertainty::normal];
      if (deviation.empty()) continue;
      if (std::abs(normal) < 1.96 * deviation[i]) errors.held += 1;
      const auto ends = component_ends(solved.view(), i, direct_point);
      const std::array<float, 3> force = {truth.shear_x[i], truth.shear_y[i], truth.normal[i]};
      for (std::size_t k = 0; k < 3; ++k) {
        if (ends[2 * k] <= force[k] && force[k] <= ends[2 * k + 1]) errors.between[k] += 1;
      }
    }
  }
  return errors;
}

inline Errors paper_errors(const Simulator& simulator) {
  const SolverPlan plan = plan_of(simulator.scene(), Estimator::paper);
  return errors_of(simulator, [&](const FrameView& frame) { return solve_on_host(plan, frame); });
}

/// Solves frame by frame, carrying friction over.
inline Errors contact_errors(const Simulator& simulator, const FrictionKnowledge& friction = {}) {
  const SolverPlan direct = plan_of(simulator.scene(), Estimator::direct);
  SolverPlan plan = plan_of(simulator.scene(), Estimator::contact);
  plan.friction = friction;
  ContactEstimator estimator(plan);
  return errors_of(simulator, [&](const FrameView& frame) {
    ForceField field = solve_on_host(direct, frame);
    estimator.resolve(field);
    return field;
  });
}

}  // namespace pillarfield
