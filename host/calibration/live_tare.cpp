#include "pillarfield/live_tare.h"

#include <utility>

#include "pillarfield/tare.h"

namespace pillarfield {

void LiveTare::start(std::chrono::nanoseconds duration, bool preloaded) {
  duration_ = duration;
  preloaded_ = preloaded;
  statistics_.emplace("tare", skin_, type_);
  first_.reset();
}

const std::vector<float>* LiveTare::add(const FrameView& frame, std::chrono::nanoseconds arrived) {
  constexpr int kMostFrames = 50;
  if (!statistics_) return nullptr;
  if (!first_) first_ = next_ = arrived;
  if (arrived >= next_) {
    statistics_->add(frame);
    next_ += duration_ / kMostFrames;
  }
  if (arrived - *first_ < duration_ || statistics_->frames() < kLeastTareFrames) return nullptr;
  return &finish();
}

const std::vector<float>& LiveTare::finish() {
  const FrameStatistics unloaded = *std::exchange(statistics_, std::nullopt);
  const SkinCalibration before = blank_calibration(skin_);
  static_cast<void>(take_tare(before, unloaded, {.preloaded = preloaded_}));  // Refuses a touch.
  tare_.clear();
  for (const SenselStatistics& sensel : unloaded.sensels()) {
    tare_.push_back(static_cast<float>(sensel.mean));
  }
  return tare_;
}

}  // namespace pillarfield
