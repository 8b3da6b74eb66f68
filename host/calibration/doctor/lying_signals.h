#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "calibration/doctor/examination.h"

namespace pillarfield {

/// The signals of a frame with a contact, by the places of the sensels, and what a place must show
/// of the contact if its neighbours are right.
class LyingSignals {
 public:
  LyingSignals(const Examination& seen, std::uint32_t frame);

  [[nodiscard]] float of(std::size_t sensel) const { return signals_[sensel]; }

  /// What three quarters of the good neighbours exceed; 0 with fewer than three of them.
  [[nodiscard]] float least_under_contact(std::uint32_t row, std::uint32_t col) const;

  /// The same for one small contact, without holes: what lies between two loaded neighbours is
  /// loaded, and what lies beside its peak.
  [[nodiscard]] float least_under_small_contact(std::uint32_t row, std::uint32_t col) const;

 private:
  /// The signal of a good sensel at a place; null if there is none.
  [[nodiscard]] const float* at(std::uint32_t row, std::uint32_t col) const;
  /// Half of what a Gaussian of the peak's other neighbours has there: flank² / opposite, at most
  /// flank.
  [[nodiscard]] float least_beside_peak(std::uint32_t row, std::uint32_t col) const;

  const Examination& seen_;
  std::span<const float> signals_;
  SenselPlace peak_;
};

}  // namespace pillarfield
