#pragma once

#include <span>

#include "pillarfield/equilibration.h"

namespace pillarfield {

/// How a sensel answered uniform pressure. Its gain is newtons_per_count · k − swallowed, for the k
/// that all sensels share.
struct Response {
  enum class Kind : std::uint8_t { good, unresponsive, one_level, saturated };
  Kind kind = Kind::unresponsive;
  double newtons_per_count = 0;
  double swallowed = 0;    ///< gain that a known dead zone stands for
  double dead_zone_n = 0;  ///< force that it swallows, where the pressures tell
  double misfit = 0;       ///< sum of the squared residuals of the line, by weight
  double answered = 0;     ///< sum of the squared answers, by weight
};

/// Fits the responses of single sensels to several presses.
class ResponseFit {
 public:
  /// Both must outlive it. Needs the tare plane.
  ResponseFit(std::span<const UniformPress> presses, const Calibration& planes);

  /// The number of different pressures.
  [[nodiscard]] std::size_t levels() const { return levels_; }

  [[nodiscard]] Response operator()(std::size_t sensel) const;

 private:
  struct Sums;
  [[nodiscard]] bool answers(const SenselStatistics& pressed, std::size_t sensel) const;
  [[nodiscard]] double answer(const SenselStatistics& pressed, std::size_t sensel) const;
  [[nodiscard]] Response ratio(const Sums& sums, std::size_t sensel) const;
  [[nodiscard]] static Response line(const Sums& sums);

  std::span<const UniformPress> presses_;
  const Calibration& planes_;
  double area_mm2_;
  std::size_t levels_;
};

}  // namespace pillarfield
