#pragma once

#include <optional>

#include "contacts/fading_line.h"
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
  [[nodiscard]] bool turns(double step_s, double change) const;
  void remember_swing();

  double time_s_ = 0;
  double ratio_ = 0;
  int frames_ = 0;
  FadingLine line_;     ///< ratio over time, since it last changed its course
  double peak_ = 0;     ///< largest ratio since it last fell
  double swing_ = 0;    ///< largest ratio from which it fell, and which it has not exceeded since
  double swing_s_ = 0;  ///< the time then
};

}  // namespace pillarfield
