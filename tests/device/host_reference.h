#pragma once

#include <vector>

#include "pillarfield/processor.h"
#include "tests/device/same_bits.h"

namespace pillarfield {

/// The host's results of frames in sequence, each with what the frames before it leave.
class HostReference {
 public:
  explicit HostReference(const SolverPlan& plan) : processor_(open_device("host"), plan) {}

  /// Valid until the call after the next one.
  [[nodiscard]] ForceFieldView solve(const FrameView& frame) {
    processor_.submit(frame);
    return processor_.receive();
  }

  [[nodiscard]] std::vector<float> tare() const { return processor_.tare(); }

 private:
  Processor processor_;
};

/// Expects the same planes bit for bit.
inline void expect_same_planes(const ForceFieldView& actual, const ForceFieldView& expected) {
  expect_same_bits(actual, expected);
  expect_same_bits(actual.magnitude, expected.magnitude, "magnitude");
  expect_same_bits(actual.theta, expected.theta, "theta");
  expect_same_bits(actual.phi, expected.phi, "phi");
  for (std::size_t plane = 0; plane < kUncertaintyPlanes; ++plane) {
    const auto which = static_cast<Uncertainty>(plane);
    expect_same_bits(actual.uncertainty[which], expected.uncertainty[which], name_of(which));
  }
}

}  // namespace pillarfield
