#pragma once

#include <optional>

#include "viewer/app/panels/plot.h"

namespace pillarfield::viewer {

/// The part of the curves on display: chosen by zooming and panning within the whole.
class TimeWindow {
 public:
  /// Shortest part, s.
  static constexpr double kLeastSeconds = 1e-3;

  /// The part of `whole` to show: all of it, or the part chosen; of a sensor (`lasts_s` > 0) the
  /// last `lasts_s` seconds. A chosen part that reached the end of a sensor's curves follows it.
  [[nodiscard]] Span of(const Span& whole, double lasts_s) const;

  /// Shows a part of `whole`: `factor` above 1 enlarges about the time `at_s`.
  void zoom(const Span& whole, double lasts_s, double at_s, double factor);
  /// Moves the part by `seconds` within `whole`.
  void pan(const Span& whole, double lasts_s, double seconds);
  void reset() { chosen_.reset(); }
  [[nodiscard]] bool is_chosen() const { return chosen_.has_value(); }

 private:
  void choose(const Span& whole, double from, double length);

  std::optional<Span> chosen_;
  bool at_end_ = false;  ///< the part reaches the end of the whole
};

}  // namespace pillarfield::viewer
