#pragma once

#include <chrono>
#include <memory>

#include "pillarfield/frame_stream.h"

namespace pillarfield {

/// The clock of a paced stream; tests supply their own.
class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  [[nodiscard]] virtual std::chrono::nanoseconds now() = 0;

  /// May return early.
  virtual void sleep_until(std::chrono::nanoseconds time) = 0;
};

/// The public paced_stream() with another clock.
[[nodiscard]] std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream,
                                                        const Pace& pace,
                                                        std::shared_ptr<Clock> clock);

}  // namespace pillarfield
