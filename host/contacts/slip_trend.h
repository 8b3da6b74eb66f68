#pragma once

#include <optional>

#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// The trend of a contact's ratio of shear to normal force, of the sums, and when it reaches the
/// friction (docs/contacts_found.md).
class SlipTrend {
 public:
  /// The ratio at a time after those before. A time that is not later starts a new trend.
  void add(double time_s, double ratio);

  /// Time at which the ratio reaches this friction, of this standard deviation: s from the newest
  /// frame, probabilities within SlipForecast::kWithinS. Unset before four frames.
  [[nodiscard]] std::optional<SlipForecast> forecast(double friction, double deviation) const;

 private:
  /// A line by weighted least squares, from the newest frame.
  struct Line {
    double weights = 0;
    double times = 0;
    double time_squares = 0;
    double ratios = 0;
    double ratio_squares = 0;
    double products = 0;

    void advance(double step_s, double change, double memory_s);
    [[nodiscard]] double spread() const { return time_squares - times * times / weights; }
    [[nodiscard]] double rate() const { return (products - times * ratios / weights) / spread(); }
    [[nodiscard]] double noise() const;
  };

  double time_s_ = 0;
  double ratio_ = 0;
  int frames_ = 0;
  Line present_;
  Line lasting_;
};

}  // namespace pillarfield
