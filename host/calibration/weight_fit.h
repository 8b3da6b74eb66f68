// Gains, exponent and sensitivity of sensels whose loads add up to a known weight
// (docs/calibration.md).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calibration/banded_factor.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// A reading of a sensel in a frame, counts.
struct WeighedReading {
  std::uint32_t sensel;
  float reading;
};

/// A frame in which the whole weight stands on the array.
struct WeighedFrame {
  std::vector<WeighedReading> readings;
  double weight_n = 0;
  double guessed = 0;          ///< share of the weight that stands on missing sensels
  double frames_at_place = 1;  ///< frames in which the weight stands at the same place
};

/// V of a reading: that of a curve, or reference (r / reference)^exponent. Odd.
struct WeightResponse {
  ResponseCurve curve;  ///< empty: the power
  double reference = 1;
  double exponent = 1;

  struct Point {
    double load;
    double slope;  ///< d load / d log reading
  };
  [[nodiscard]] Point at(double reading) const;
};

/// Facts of the array that are known before the fit.
struct WeighedArray {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double threshold = 0;        ///< of a reading, counts
  std::vector<double> noise;   ///< of a reading, counts
  std::vector<double> copies;  ///< 1 + the missing sensels for which a sensel stands
  std::vector<float> zones;    ///< as Calibration::dead_zone

  /// Amount that a reading above the threshold adds to V.
  [[nodiscard]] double zone(std::uint32_t sensel, double reading) const {
    return zones.empty() || !(reading > threshold) ? 0 : zones[sensel];
  }
};

/// Maximum a posteriori of the logarithmic gains x, the exponent and the logarithm of the counts
/// per newton, by Gauss-Newton steps with robust weights of the frames.
class WeightFit {
 public:
  /// Standard deviation of the logarithm of the exponent before the frames are seen.
  static constexpr double kExponentSpread = 0.4;

  WeightFit(std::span<const WeighedFrame> frames, WeighedArray array, WeightResponse response);

  /// Fits all, or with an exponent and its known deviation the rest.
  struct Exponent {
    double value;
    double deviation;
  };
  void fit(std::optional<Exponent> known);

  [[nodiscard]] std::span<const WeighedFrame> frames() const { return frames_; }
  [[nodiscard]] const WeighedArray& array() const { return array_; }
  [[nodiscard]] const WeightResponse& response() const { return response_; }
  [[nodiscard]] const std::vector<double>& log_gains() const { return x_; }
  [[nodiscard]] double exponent_deviation() const { return exponent_deviation_; }
  /// Relative, of the sum of a frame beyond noise: now, and as it was at first.
  [[nodiscard]] double misfit() const { return misfit_; }
  [[nodiscard]] double first_misfit() const { return first_misfit_; }
  /// Spread of the logarithmic gains between sensels, as the visited ones show.
  [[nodiscard]] double spread() const { return spread_; }
  /// Information of each frame; 0: left out.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

  /// Errors of the fit, one possible case.
  struct Errors {
    std::vector<double> log_gains;
    double exponent;
    double log_counts_per_newton;
  };
  /// Draws from the posterior, given independent normal variates, two more than sensels.
  [[nodiscard]] Errors draw(std::span<const double> independent) const;

 private:
  /// The normal equations: x, then exponent and log k, which all frames share.
  struct Equations {
    BandedFactor factor;
    std::vector<double> right;
    std::array<std::vector<double>, 2> beside;  ///< from x to the shared ones
    std::array<double, 2> shared_right{};
    std::array<double, 3> shared{};  ///< exponent², exponent · log k, (log k)²
  };

  /// Sums over a frame of the variances of V by noise.
  struct NoiseSums {
    double square = 0;
    double by_exponent = 0;        ///< times d log(deviation) / d exponent
    double by_exponent_twice = 0;  ///< times its square
  };

  void linearise();
  void estimate_misfit();
  void weigh();
  [[nodiscard]] double step();
  void settle(int steps);
  [[nodiscard]] double start_exponent() const;
  void estimate_spread();
  void state_deviations();
  [[nodiscard]] Equations equations() const;
  [[nodiscard]] double variance(std::size_t frame) const;
  [[nodiscard]] double exponent_variance(double information) const;
  [[nodiscard]] std::size_t place(std::uint32_t sensel) const;

  std::span<const WeighedFrame> frames_;
  WeighedArray array_;
  WeightResponse response_;
  double first_exponent_;
  std::optional<Exponent> known_;
  std::vector<std::size_t> begins_;
  std::size_t reach_ = 0;  ///< of a frame, in places
  std::vector<double> x_;
  double log_k_ = 0;
  double misfit_ = 0;
  double first_misfit_ = 0;
  double spread_;
  double exponent_deviation_ = 0;
  // At x_: one for each reading, then one for each frame.
  std::vector<double> slopes_;
  std::vector<double> noise_slopes_;  ///< half the slopes of noise_squares_ in x
  std::vector<double> residuals_;
  std::vector<double> noise_squares_;  ///< variance of a residual by noise
  std::vector<double> exponent_slopes_;
  std::vector<double> noise_by_exponent_;  ///< half the slope of noise_squares_ in the exponent
  std::vector<double> exponent_noise_;     ///< variance of exponent_slopes_ by noise
  std::vector<double> weights_;
  // The posterior, after fit().
  std::optional<Equations> posterior_;
  std::array<std::vector<double>, 2> responses_;  ///< of x to the shared ones
  std::array<double, 3> covariance_{};            ///< of the shared ones, in their order
};

/// Relative deviations of loads of 0.3 to 2 times the weight, on bases of 0.7 to 1.4 times the
/// length, anywhere on the array.
struct WeightDeviations {
  double total = 0;           ///< in a frame, with its noise and what lies below the threshold
  double element = 0;         ///< of a sensel's load, weighted by the load
  std::vector<double> gains;  ///< of each sensel
};
[[nodiscard]] WeightDeviations deviations_of(const WeightFit& fit, int samples);

}  // namespace pillarfield
