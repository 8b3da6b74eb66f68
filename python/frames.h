#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <vector>

#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"
#include "python/arrays.h"

namespace pillarfield::python {

/// The calibration of a source of frames.
[[nodiscard]] SkinCalibration calibration_of(const FrameSource& source);

}  // namespace pillarfield::python
