// Gains, exponent and sensitivity of sensels whose loads add up to a known weight
// (docs/derivations/weight.md).

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

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

/// What is known of the array before.
struct WeighedArray {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<double> noise;   ///< of a reading, counts
  std::vector<double> copies;  ///< 1 + the missing sensels for which a sensel stands
};

/// Maximum a posteriori of the logarithmic gains x, the logarithm of the counts per newton and the
/// exponent, with robust weights of the frames; deviations from samples of the posterior.
class WeightFit {
 public:
  WeightFit(std::span<const WeighedFrame> frames, WeighedArray array, WeightResponse response);

  /// Fits gains, and the exponent too where `exponent` holds.
  void fit(bool exponent);

  /// Makes `exponent` of known deviation that of the fit.
  void keep_exponent(double exponent, double deviation);

  /// Relative deviations of loads of 0.3 to 2 times the weight, anywhere on the array.
  struct Deviations {
    double total = 0;
    double element = 0;         ///< of a sensel's load, weighted by the load
    std::vector<double> gains;  ///< of each sensel
  };
  [[nodiscard]] Deviations deviations(int samples) const;

  [[nodiscard]] const std::vector<double>& log_gains() const { return x_; }
  [[nodiscard]] const WeightResponse& response() const { return response_; }
  [[nodiscard]] double exponent_deviation() const;
  [[nodiscard]] double misfit() const { return misfit_; }
  [[nodiscard]] double first_misfit() const { return first_misfit_; }
  [[nodiscard]] double spread() const { return spread_; }
  /// Weight of each frame over its variance; 0: left out.
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  [[nodiscard]] double at_exponent(double exponent, int rounds);
  void linearise();
  void weigh(bool first);
  void estimate_misfit();
  void search_exponent(double low, double high);
  void fit_once(bool exponent);
  [[nodiscard]] double objective() const;
  [[nodiscard]] double variance(std::size_t frame) const;
  [[nodiscard]] std::vector<double> gradient(std::span<const double> of_frames) const;
  [[nodiscard]] std::vector<double> along(std::span<const double> x) const;
  [[nodiscard]] double weighted_mean(std::span<const double> of_frames) const;
  [[nodiscard]] std::vector<double> centred(std::span<const double> of_frames) const;
  [[nodiscard]] std::vector<double> solve(const std::vector<double>& right) const;

  std::span<const WeighedFrame> frames_;
  WeighedArray array_;
  WeightResponse response_;
  double first_exponent_;
  std::vector<std::size_t> begins_;
  std::vector<double> x_;
  double log_k_ = 0;
  double misfit_ = 0;
  double first_misfit_ = 0;
  double spread_;
  double kept_deviation_ = -1;  ///< of a kept exponent; below zero: from the frames
  // At x_: each by reading, then by frame.
  std::vector<double> slopes_;
  std::vector<double> residuals_;
  std::vector<double> noise_squares_;
  std::vector<double> exponent_slopes_;
  std::vector<double> weights_;
};

}  // namespace pillarfield
