#include "viewer/source/live_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pillarfield::viewer {
namespace {

std::chrono::nanoseconds now_of_fields() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

}  // namespace

void NewestField::count(std::chrono::nanoseconds arrived) {
  const std::scoped_lock lock(mutex_);
  ++produced_;
  times_.add(arrived, now_of_fields());
}

void NewestField::set(ShownField field) {
  {
    std::optional<ShownField> next(std::move(field));
    const std::scoped_lock lock(mutex_);
    std::swap(waiting_, next);
  }
  wake_display();
}

void NewestField::end(std::exception_ptr failure) {
  {
    const std::scoped_lock lock(mutex_);
    failed_ = std::move(failure);
  }
  wake_display();
}

void NewestField::wake_display() {
  const std::scoped_lock lock(waking_);
  if (wake_) wake_();
}

std::optional<ShownField> NewestField::take() {
  const std::scoped_lock lock(mutex_);
  if (waiting_) {
    ++taken_;
    return std::exchange(waiting_, std::nullopt);
  }
  if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
  return std::nullopt;
}

PlayerStatistics NewestField::statistics() const {
  const std::scoped_lock lock(mutex_);
  times_.forget_before(now_of_fields());
  PlayerStatistics statistics;
  statistics.produced = produced_;
  statistics.taken = taken_;
  statistics.waiting = waiting_ ? 1 : 0;
  statistics.not_shown = statistics.produced - statistics.taken - statistics.waiting;
  statistics.produced_hz = times_.rate_hz();
  statistics.produce_ms_median = times_.median_ms();
  statistics.produce_ms_worst = times_.worst_ms();
  return statistics;
}

void NewestField::on_new_field(std::function<void()> wake) {
  const std::scoped_lock lock(waking_);
  wake_ = std::move(wake);
}

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
          .playing = !wanted_.paused,
          .loops = false,
          .follows = true,
          .speed = 1,
          .rate_hz = rate_hz};
}

}  // namespace pillarfield::viewer
