#include "pillarfield/frame_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pillarfield/error.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

/// Readings beyond it are missing, as in the solve.
constexpr auto kLargest = static_cast<float>(kMaxCounts);

}  // namespace

void SenselStatistics::add(float reading, float full_scale) {
  if (!(std::abs(reading) <= kLargest)) return;
  lowest = readings == 0 ? reading : std::min(lowest, reading);
  highest = readings == 0 ? reading : std::max(highest, reading);
  ++readings;
  if (reading >= full_scale) ++saturated;
  const double step = reading - mean;
  mean += step / readings;
  squares += step * (reading - mean);
}

double SenselStatistics::deviation() const {
  return readings < 2 ? 0 : std::sqrt(squares / (readings - 1));
}

FrameStatistics::FrameStatistics(std::string name, const Skin& skin, SenselType type)
    : name_(std::move(name)), skin_(skin), type_(type), sensels_(skin.sensels()) {}

void FrameStatistics::add(const FrameView& frame) {
  require_frame(frame, skin_, type_, name_);
  const auto full_scale =
      static_cast<float>(skin_.full_scale_counts.value_or(std::numeric_limits<double>::infinity()));
  for_each_row(frame, [&](std::size_t row, const auto* readings) {
    SenselStatistics* const sensels = &sensels_[row * skin_.cols];
    for (std::size_t col = 0; col < skin_.cols; ++col) {
      sensels[col].add(static_cast<float>(readings[col]), full_scale);
    }
  });
  ++frames_;
}

void FrameStatistics::add(std::span<const float> readings) {
  const auto full_scale =
      static_cast<float>(skin_.full_scale_counts.value_or(std::numeric_limits<double>::infinity()));
  for (std::size_t i = 0; i < sensels_.size(); ++i) sensels_[i].add(readings[i], full_scale);
  ++frames_;
}

void require_frames(const FrameStatistics& statistics, std::uint32_t least) {
  if (statistics.frames() >= least) return;
  throw Error(statistics.name(), fmt::format("has {} frames", statistics.frames()),
              fmt::format("give at least {}", least));
}

FrameBuffer mean_frame(const FrameStatistics& frames) {
  const Skin& skin = frames.skin();
  FrameBuffer mean(SenselType::f32, skin.rows, skin.cols);
  const auto readings = mean.readings<float>();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const SenselStatistics& sensel = frames.sensels()[i];
    readings[i] = static_cast<float>(sensel.saturated > 0 ? *skin.full_scale_counts : sensel.mean);
    if (sensel.readings == 0) readings[i] = std::nanf("");
  }
  return mean;
}

}  // namespace pillarfield
