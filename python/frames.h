#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <mutex>
#include <utility>

#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"
#include "python/arrays.h"

namespace pillarfield::python {

/// A source of frames, used by one thread at a time.
struct Frames {
  explicit Frames(std::unique_ptr<FrameSource> frames) : source(std::move(frames)) {}

  std::unique_ptr<FrameSource> source;
  std::mutex alone;
};

}  // namespace pillarfield::python
