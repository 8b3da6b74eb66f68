#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"
#include "python/arrays.h"

namespace pillarfield::python {

/// The layout of this name; unset for an empty one. Throws Error for another word.
[[nodiscard]] std::optional<SkinLayout> layout_in(const std::string& name);

/// The frames first, first + step, ... of a file.
struct IndexRange {
  IndexRange(std::int64_t first_frame, std::int64_t frame_step, std::int64_t frame_count)
      : first(first_frame), step(frame_step), count(static_cast<std::size_t>(frame_count)) {
    if (frame_count < 0) throw pybind11::index_error("the number of frames is negative");
  }

  /// Throws IndexError unless all of them exist.
  void check(std::uint64_t frames) const {
    const auto size = static_cast<std::int64_t>(frames);
    const auto exists = [&](std::int64_t index) { return index >= 0 && index < size; };
    if (count == 0) return;
    if (count > frames || !exists(first) || (count > 1 && (step > size || step < -size)) ||
        (count > 1 && !exists(first + static_cast<std::int64_t>(count - 1) * step))) {
      throw pybind11::index_error("frame index out of range");
    }
  }

  std::uint64_t operator[](std::size_t i) const {
    return static_cast<std::uint64_t>(first + static_cast<std::int64_t>(i) * step);
  }

  std::int64_t first;
  std::int64_t step;
  std::size_t count;
};

/// A source of frames, used by one thread at a time; between frames, a signal handler of that
/// thread may use it too.
struct Frames {
  explicit Frames(std::unique_ptr<FrameSource> frames) : source(std::move(frames)) {}

  std::unique_ptr<FrameSource> source;
  std::recursive_mutex alone;
};

}  // namespace pillarfield::python
