#include "calibration/doctor/kept_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pillarfield/skin.h"
#include "skin/raw_reading.h"

namespace pillarfield {

KeptFrames::KeptFrames(std::uint32_t rows, std::uint32_t cols)
    : sensels_(std::size_t{rows} * cols),
      most_(std::clamp(kMostKeptReadings / sensels_, kLeastKeptFrames, kMostKeptFrames)) {}

void KeptFrames::add(const FrameView& frame, double time_s) {
  if (added_++ % stride_ != 0) return;
  if (times_.size() == most_) {
    drop_every_second();
    if ((added_ - 1) % stride_ != 0) return;
  }
  times_.push_back(time_s);
  for_each_row(frame, [&](std::size_t, const auto* readings) {
    for (std::size_t col = 0; col < frame.cols; ++col) {
      const auto reading = static_cast<float>(readings[col]);
      const bool counts = std::abs(reading) <= static_cast<float>(kMaxCounts);
      readings_.push_back(counts ? reading : std::numeric_limits<float>::quiet_NaN());
    }
  });
}

void KeptFrames::read_sensel(std::size_t sensel, SenselReadings& to) const {
  to.values.clear();
  to.frames.clear();
  for (std::uint32_t index = 0; index < frames(); ++index) {
    const float reading = frame(index)[sensel];
    if (std::isnan(reading)) continue;
    to.values.push_back(reading);
    to.frames.push_back(index);
  }
}

void KeptFrames::drop_every_second() {
  const std::size_t left = (times_.size() + 1) / 2;
  for (std::size_t i = 1; i < left; ++i) {
    times_[i] = times_[2 * i];
    std::ranges::copy(frame(2 * i), frame(i).begin());
  }
  times_.resize(left);
  readings_.resize(left * sensels_);
  stride_ *= 2;
}

}  // namespace pillarfield
