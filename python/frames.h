#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <mutex>
#include <utility>

#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"
#include "python/arrays.h"

namespace pillarfield::python {

/// A source of frames, used by one thread at a time; between frames, a signal handler of that
/// thread may use it too.
struct Frames {
  explicit Frames(std::unique_ptr<FrameSource> frames) : source(std::move(frames)) {}

  std::unique_ptr<FrameSource> source;
  std::recursive_mutex alone;
};

}  // namespace pillarfield::python
