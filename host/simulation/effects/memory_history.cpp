#include "simulation/effects/memory_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "simulation/scene/scene_limits.h"

namespace pillarfield {
namespace {

constexpr int kLoops = 16;
// Time constants from 10^-2.5 to 10^4 s.
constexpr int kCreepStates = 14;
constexpr int kCreepStatesPerDecade = 2;
constexpr double kShortestCreepS = 0.00316227766;

}  // namespace

MemoryHistory::MemoryHistory(const Scene& scene)
    : linear_(-2 * scene.sensor.hysteresis),
      previous_(scene.skin.sensels()),
      readings_(scene.skin.sensels()) {
  const SensorModel& sensor = scene.sensor;
  const double range = sensor.hysteresis_range_counts.value_or(full_scale_or_255(scene.skin));
  for (int i = 0; i < kLoops && sensor.hysteresis > 0; ++i) {
    loops_.push_back({range * (i + 0.5) / kLoops, sensor.hysteresis * 4 / kLoops});
  }
  for (int i = 0; i < kCreepStates && sensor.creep_per_decade > 0; ++i) {
    const double time_s = kShortestCreepS * std::pow(10, 1.0 * i / kCreepStatesPerDecade);
    creep_.push_back({-std::expm1(-1 / (scene.rate_hz * time_s)),
                      sensor.creep_per_decade / kCreepStatesPerDecade});
  }
  states_.resize(readings_.size() * (loops_.size() + creep_.size()));
}

bool MemoryHistory::is_needed(const SensorModel& sensor) {
  return sensor.hysteresis > 0 || sensor.creep_per_decade > 0;
}

void MemoryHistory::apply(std::uint64_t frame, std::vector<double>& v, const Signal& signal) {
  const std::scoped_lock lock(mutex_);
  if (frame + 1 < frames_) restart();
  while (frames_ < frame) {
    if (is_interrupted()) throw Error(fmt::format("frame {}", frame), "interrupted", "start again");
    step(signal(frames_));
  }
  if (frames_ == frame) step(v);
  v = readings_;
}

void MemoryHistory::restart() {
  frames_ = 0;
  std::ranges::fill(states_, 0.0F);
  std::ranges::fill(previous_, 0.0F);
}

void MemoryHistory::step(std::span<const double> v) {
  float* state = states_.data();
  for (std::size_t sensel = 0; sensel < v.size(); ++sensel) {
    const double now = v[sensel];
    double reading = (1 + linear_) * now;
    for (const auto& [width, weight] : loops_) {
      *state = static_cast<float>(std::max(now - width, std::min(now, double{*state})));
      reading += weight * double{*state++};
    }
    // V of the frame before has acted since then, so a step shows at once and creeps from there.
    const double before = previous_[sensel];
    for (const auto& [update, weight] : creep_) {
      *state = static_cast<float>(*state + update * (before - *state));
      reading += weight * double{*state++};
    }
    previous_[sensel] = static_cast<float>(now);
    readings_[sensel] = reading;
  }
  ++frames_;
}

}  // namespace pillarfield
