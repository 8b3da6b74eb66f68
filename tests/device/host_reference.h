#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/host_solve.h"
#include "solve/pillar_maths.h"
#include "tests/device/same_bits.h"

namespace pillarfield {

/// The host's results of frames in sequence, each with the memory, the tare and the friction that
/// the frames before it leave.
class HostReference {
 public:
  explicit HostReference(SolverPlan plan) : plan_(std::move(plan)) {
    if (plan_.estimator != Estimator::contact) return;
    contacts_.emplace(plan_);
    plan_.estimator = Estimator::direct;
  }

  [[nodiscard]] ForceField solve(const FrameView& frame) {
    ForceField forces = solve_on_host(plan_, frame, state_);
    if (contacts_) contacts_->resolve(forces);
    if (plan_.baseline_rate) follow_baseline_on_host(plan_, frame, forces, state_);
    return forces;
  }

  [[nodiscard]] const std::vector<float>& tare() const { return plan_.calibration.tare; }

 private:
  SolverPlan plan_;
  std::optional<ContactEstimator> contacts_;
  SensorState state_;
};

/// Expects the planes of the host bit for bit, and angles, which it does not compute, of the
/// forces.
inline void expect_same_planes(const ForceFieldView& actual, const ForceField& expected) {
  expect_same_bits(actual, expected.view());
  for (std::size_t plane = 0; plane < kUncertaintyPlanes; ++plane) {
    const auto which = static_cast<Uncertainty>(plane);
    expect_same_bits(actual.uncertainty[which], expected.uncertainty[which], name_of(which));
  }
  std::vector<float> magnitude;
  std::vector<float> theta;
  std::vector<float> phi;
  for (std::size_t i = 0; i < actual.theta.size(); ++i) {
    const auto direction = single_precision::direction_of(
        {expected.shear_x[i], expected.shear_y[i], expected.normal[i]});
    magnitude.push_back(direction.magnitude);
    theta.push_back(direction.theta);
    phi.push_back(direction.phi);
  }
  expect_same_bits(actual.magnitude, magnitude, "magnitude");
  expect_same_bits(actual.theta, theta, "theta");
  expect_same_bits(actual.phi, phi, "phi");
}

}  // namespace pillarfield
