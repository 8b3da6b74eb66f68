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

template <class Keep>
void KeptFrames::keep(Keep is_kept) {
  std::size_t left = 0;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (!is_kept(i)) continue;
    times_[left] = times_[i];
    numbers_[left] = numbers_[i];
    kinds_[left] = kinds_[i];
    if (left != i) std::ranges::copy(frame(i), frame(left).begin());
    ++left;
  }
  times_.resize(left);
  numbers_.resize(left);
  kinds_.resize(left);
  readings_.resize(left * sensels_);
}

void KeptFrames::add(const FrameView& frame, double time_s, FrameKind kind) {
  if (added_++ % stride_ != 0) return;
  if (times_.size() == most_) {
    keep([](std::size_t index) { return index % 2 == 0; });
    stride_ *= 2;
    if ((added_ - 1) % stride_ != 0) return;
  }
  times_.push_back(time_s);
  numbers_.push_back(added_ - 1);
  kinds_.push_back(kind);
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

void KeptFrames::drop(FrameKind kind) {
  keep([&](std::size_t index) { return kinds_[index] != kind; });
}

}  // namespace pillarfield
