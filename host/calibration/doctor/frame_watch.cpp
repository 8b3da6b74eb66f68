#include "calibration/doctor/frame_watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/quantile.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

/// Sensels that change from each frame to the next at least, if equal frames are no chance.
constexpr std::size_t kLeastChanges = 8;
/// Longest run of uniform frames that is a loss.
constexpr std::uint64_t kLongestLoss = 8;
constexpr std::size_t kLeastUniform = 4;  ///< sensels of a uniform frame

}  // namespace

FrameKind FrameWatch::add(const FrameView& frame) {
  const std::uint64_t number = frames_++;
  current_.clear();
  for_each_row(frame, [&](std::size_t, const auto* readings) {
    for (std::size_t col = 0; col < frame.cols; ++col) {
      current_.push_back(static_cast<float>(readings[col]));
    }
  });
  std::uint32_t changed = 0;
  for (std::size_t i = 0; number > 0 && i < current_.size(); ++i) {
    const bool is_same =
        current_[i] == before_[i] || (current_[i] != current_[i] && before_[i] != before_[i]);
    changed += is_same ? 0U : 1U;
  }
  if (changed > 0) all_equal_ = false;
  const bool is_repeated = number > 0 && changed == 0;
  const float first = current_.front();
  const bool is_uniform = current_.size() >= kLeastUniform &&
                          std::ranges::all_of(current_, [&](float each) { return each == first; });
  const bool is_empty =
      std::ranges::none_of(current_, [](float each) { return std::isfinite(each); });
  before_.swap(current_);
  if (is_empty) {
    empty_.add(number);
    return FrameKind::empty;
  }
  if (is_uniform) {
    if (has_mean_) {
      run_.add(number);
      uniform_.add(number);
      value_ = first;
    }
    return FrameKind::uniform;
  }
  double mean = 0;
  for (const float each : before_) mean += std::isfinite(each) ? each : 0;
  end_run(mean / static_cast<double>(before_.size()));
  if (is_repeated) {
    repeated_.add(number);
    return FrameKind::repeated;
  }
  if (number > 0) changes_.push_back(changed);
  return FrameKind::whole;
}

void FrameWatch::end_run(double mean) {
  if (run_.frames > 0 && run_.frames <= kLongestLoss &&
      std::abs(mean - mean_) < std::abs(mean_ - value_) / 2) {
    if (lost_.frames == 0) lost_.first = run_.first;
    lost_.frames += run_.frames;
  }
  run_ = {};
  mean_ = mean;
  has_mean_ = true;
}

bool FrameWatch::repeats_are_odd() const {
  if (repeated_.frames == 0 || changes_.empty()) return false;
  std::vector<std::uint32_t> changes = changes_;
  return quantile(changes, 0.05) >= std::min(kLeastChanges, (before_.size() + 2) / 3);
}

}  // namespace pillarfield
