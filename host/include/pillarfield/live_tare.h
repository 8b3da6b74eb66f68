#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pillarfield/frame_statistics.h"

namespace pillarfield {

/// Measures the tare of an untouched skin while frames arrive, for Processor::set_tare().
///
///     LiveTare tare(skin, SenselType::u8);
///     tare.start(std::chrono::milliseconds(500));
///     if (const auto* plane = tare.add(frame, arrived)) processor.set_tare(*plane);
class LiveTare {
 public:
  LiveTare(Skin skin, SenselType type) : skin_(std::move(skin)), type_(type) {}

  /// Begins with the next frame; forgets frames added so far. `preloaded` accepts an area that
  /// reads far above the rest (TareOptions).
  void start(std::chrono::nanoseconds duration, bool preloaded = false);

  /// Whether start() was called and add() has not returned a tare since.
  [[nodiscard]] bool is_running() const { return statistics_.has_value(); }

  /// Adds a frame of the skin's size and type that arrived at `arrived`. Uses at most 50 of them,
  /// at 5 ns a sensel. At the end of the duration, and after at least kLeastTareFrames, returns the
  /// mean readings [rows, cols], counts, valid until the next start(); null before. Throws Error,
  /// and stops, if something touches the skin.
  const std::vector<float>* add(const FrameView& frame, std::chrono::nanoseconds arrived);

  /// Stops without a tare.
  void stop() { statistics_.reset(); }

 private:
  const std::vector<float>& finish();

  Skin skin_;
  SenselType type_;
  std::chrono::nanoseconds duration_{0};
  bool preloaded_ = false;
  std::optional<FrameStatistics> statistics_;
  std::optional<std::chrono::nanoseconds> first_;
  std::chrono::nanoseconds next_{0};
  std::vector<float> tare_;
};

}  // namespace pillarfield
