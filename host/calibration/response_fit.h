#pragma once

#include <span>

#include "pillarfield/equilibration.h"

namespace pillarfield {

/// Response of a sensel to uniform pressure: gain = k · newtons_per_count − dead_zone_gain, k being
/// the counts per newton of the skin.
struct Response {
  enum class Kind : std::uint8_t { good, unresponsive, one_level, saturated };
  Kind kind = Kind::unresponsive;
  double newtons_per_count = 0;
  double dead_zone_gain = 0;  ///< dead zone over response; one pressure
  double dead_zone_n = 0;     ///< dead zone as a force; several pressures
  double misfit = 0;          ///< weighted sum of squared residuals
  double responded = 0;       ///< weighted sum of squared responses
};

/// Fits the response of each sensel to one or more presses.
class ResponseFit {
 public:
  /// `presses` and `planes` must outlive the object; `planes` must have a tare.
  ResponseFit(std::span<const UniformPress> presses, const Calibration& planes);

  /// Number of different pressures.
  [[nodiscard]] std::size_t levels() const { return levels_; }

  [[nodiscard]] Response operator()(std::size_t sensel) const;

 private:
  struct Sums;
  [[nodiscard]] bool responds(const SenselStatistics& pressed, std::size_t sensel) const;
  [[nodiscard]] double response(const SenselStatistics& pressed, std::size_t sensel) const;
  [[nodiscard]] Response ratio(const Sums& sums, std::size_t sensel) const;
  [[nodiscard]] static Response line(const Sums& sums);

  std::span<const UniformPress> presses_;
  const Calibration& planes_;
  double area_mm2_;
  std::size_t levels_;
};

}  // namespace pillarfield
