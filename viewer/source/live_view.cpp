#include "viewer/source/live_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pillarfield::viewer {

double FieldClock::time_s(double sensor_s, std::chrono::nanoseconds arrived) {
  constexpr double kMostApartS = 5;
  constexpr double kLeastStepS = 1e-6;
  const double arrived_s = std::chrono::duration<double>(arrived - start_).count();
  const double by_sensor_s = sensor_s + offset_s_.value_or(arrived_s - sensor_s);
  const bool follows =
      offset_s_ && by_sensor_s > last_s_ && std::abs(by_sensor_s - arrived_s) < kMostApartS;
  last_s_ = follows ? by_sensor_s : std::max(arrived_s, last_s_ + kLeastStepS);
  offset_s_ = last_s_ - sensor_s;
  return last_s_;
}

PlayerState LiveView::state_after(std::uint64_t frames, double rate_hz) const {
  return {.frame = frames,
          .frames = 0,
          .playing = !paused_,
          .loops = false,
          .follows = true,
          .speed = 1,
          .rate_hz = rate_hz};
}

void LiveView::measure(const ShownField& field) {
  curves_->add(field);
  newest_.count(field.arrived.value());
}

}  // namespace pillarfield::viewer
