#pragma once

#include <algorithm>
#include <cmath>

namespace pillarfield {

/// A least-squares line in which later points weigh more.
class FadingLine {
 public:
  /// Adds a point `step` to the right of the newest one and `change` above it. The weights of
  /// earlier points fall by e in a step of `memory`.
  void add(double step, double change, double memory) {
    const double fade = std::exp(-step / memory);
    products_ = fade * (products_ - step * y_ - change * x_ + step * change * weights_);
    x_squares_ = fade * (x_squares_ - 2 * step * x_ + step * step * weights_);
    y_squares_ = fade * (y_squares_ - 2 * change * y_ + change * change * weights_);
    x_ = fade * (x_ - step * weights_);
    y_ = fade * (y_ - change * weights_);
    weights_ = fade * weights_ + 1;
  }

  [[nodiscard]] double weights() const { return weights_; }  ///< 1 of the newest point
  /// Sum of squares about the mean of x; the slope needs it above zero.
  [[nodiscard]] double spread() const { return x_squares_ - x_ * x_ / weights_; }
  [[nodiscard]] double slope() const { return (products_ - x_ * y_ / weights_) / spread(); }
  /// Height of the line above the newest point, at that point.
  [[nodiscard]] double height() const { return (y_ - slope() * x_) / weights_; }
  /// Variance of a point about the line.
  [[nodiscard]] double noise() const {
    const double rest = y_squares_ - y_ * y_ / weights_ - slope() * slope() * spread();
    return std::max(rest, 0.0) / std::max(weights_ - 2, 1.0);
  }

 private:
  // Weighted sums, from the newest point.
  double weights_ = 0;
  double x_ = 0;
  double y_ = 0;
  double x_squares_ = 0;
  double y_squares_ = 0;
  double products_ = 0;
};

}  // namespace pillarfield
