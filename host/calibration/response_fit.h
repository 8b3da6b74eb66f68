#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pillarfield/equilibration.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// Response that all sensels share: force = curve(reading) + dead_zone_n.
struct CommonResponse {
  ResponseCurve curve;     ///< its loads are forces, N
  double dead_zone_n = 0;  ///< force below which the sensels read zero

  /// Force at a reading above zero.
  [[nodiscard]] double force_at(double reading) const {
    return load_at(curve, reading) + dead_zone_n;
  }
};

/// The response through readings under known forces: two or more of each, above zero, increasing.
/// The dead zone is that for which log(force − dead zone) is nearest a line in log(reading), the
/// power law, or where that fits much better, nearest such a line with a term in the reading, a
/// bent curve; 0 with two or three forces. Two knots below the first force and one beyond the last
/// continue the response as the power law through the nearest two, or along the bent curve, which
/// also gives a knot between any two.
[[nodiscard]] CommonResponse fit_common_response(const std::vector<double>& forces_n,
                                                 const std::vector<double>& readings);

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

/// Fits the response of each sensel to one or more presses: a straight line, or after straighten()
/// a multiple of the common response.
class ResponseFit {
 public:
  /// `planes` must outlive the object, and have a tare.
  ResponseFit(std::span<const UniformPress> presses, const Calibration& planes);

  [[nodiscard]] const std::vector<UniformPress>& presses() const { return presses_; }
  [[nodiscard]] const Calibration& planes() const { return planes_; }

  /// The different pressures, kPa, increasing.
  [[nodiscard]] const std::vector<double>& levels() const { return levels_; }

  /// Force on the pillar of a sensel, times linear_sum(), N.
  [[nodiscard]] double force_n(const UniformPress& press, std::size_t sensel) const;

  /// Mean reading − tare under a press; unset if the sensel does not respond or is saturated.
  [[nodiscard]] std::optional<double> response(const UniformPress& press, std::size_t sensel) const;

  /// From now on fits multiples of `common`, whose highest reading under pressure is `reading` at
  /// `force_n`: a sensel reads common(force) · force_n / reading / newtons_per_count.
  void straighten(CommonResponse common, double force_n, double reading);

  [[nodiscard]] const std::optional<CommonResponse>& common() const { return common_; }

  /// Newtons of a straight line per count of the common response.
  [[nodiscard]] double newtons_per_reading() const { return newtons_per_reading_; }

  [[nodiscard]] Response operator()(std::size_t sensel) const;

  /// Force at a response of a sensel whose fit is `fitted`, N.
  [[nodiscard]] double force_at(const Response& fitted, double response) const;

 private:
  struct Sums;
  [[nodiscard]] double fitted_force_n(const UniformPress& press, std::size_t sensel) const;
  [[nodiscard]] Response ratio(const Sums& sums, std::size_t sensel) const;
  [[nodiscard]] Response line(const Sums& sums) const;

  std::vector<UniformPress> presses_;
  const Calibration& planes_;
  std::vector<double> levels_;
  std::optional<CommonResponse> common_;
  double newtons_per_reading_ = 0;
};

/// The mean readings of the sensels that respond to all presses, at each level.
struct LevelReadings {
  std::vector<double> forces_n;  ///< on a pillar, times linear_sum()
  std::vector<double> readings;
};

/// The readings of the good sensels (1 in `mask`, or an empty mask); unset if less than half of
/// them respond to all presses or the readings do not increase with the pressure.
[[nodiscard]] std::optional<LevelReadings> level_readings(const ResponseFit& fit,
                                                          const std::vector<std::uint8_t>& mask);

}  // namespace pillarfield
