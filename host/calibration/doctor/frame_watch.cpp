#include "calibration/doctor/frame_watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

/// A reading at an end of the range, where an array may rest.
bool is_end(float reading) { return reading == 0 || reading == 255 || reading == 65535; }

bool is_same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

FrameKind FrameWatch::add(const FrameView& frame) {
  const std::uint64_t number = frames_++;
  current_.clear();
  for_each_row(frame, [&](std::size_t, const auto* readings) {
    for (std::size_t col = 0; col < frame.cols; ++col) {
      current_.push_back(static_cast<float>(readings[col]));
    }
  });
  numbers_.clear();
  std::ranges::copy_if(current_, std::back_inserter(numbers_),
                       [](float each) { return std::isfinite(each); });
  double mean = 0;
  for (const float each : numbers_) mean += each / static_cast<double>(current_.size());
  const float middle = numbers_.empty() ? 0 : median(numbers_);
  // A sensel that is absent keeps its value in a lost frame.
  std::uint32_t changed = 0;
  std::size_t equal = 0;
  bool is_uniform = true;
  for (std::size_t i = 0; i < current_.size(); ++i) {
    const bool has_changed = number > 0 && !is_same(current_[i], before_[i]);
    changed += has_changed ? 1U : 0U;
    equal += current_[i] == middle ? 1U : 0U;
    is_uniform = is_uniform && (current_[i] == middle || (number > 0 && !has_changed));
  }
  is_uniform = is_uniform && equal >= kLeastUniform && 2 * equal > numbers_.size();
  if (changed > 0 || (equal == current_.size() && is_end(middle))) all_equal_ = false;
  before_.swap(current_);
  if (numbers_.empty()) {
    empty_.add(number);
    return FrameKind::empty;
  }
  if (is_uniform) {
    if (has_mean_) {
      run_.add(number);
      uniform_.add(number);
      value_ = middle;
      run_mean_ = mean;
    }
    return FrameKind::uniform;
  }
  end_run(mean);
  if (number > 0 && changed == 0) {
    repeated_.add(number);
    return FrameKind::repeated;
  }
  if (number > 0) changes_.push_back(changed);
  if (2 * equal > numbers_.size()) ++flat_;
  return FrameKind::whole;
}

void FrameWatch::end_run(double mean) {
  if (run_.frames > 0 && run_.frames <= kLongestLoss &&
      std::abs(mean - mean_) < std::abs(mean_ - run_mean_) / 2) {
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
