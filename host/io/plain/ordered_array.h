#pragma once

#include <memory>
#include <vector>

#include "io/plain/number_array.h"
#include "pillarfield/array_axes.h"

namespace pillarfield {

/// The array with its axes in the order frames, rows, columns; `axes` is their order in `array`.
/// Holds all numbers in memory unless the first axis counts frames. Throws Error if the array has
/// another number of axes, or needs more than 1 GiB.
[[nodiscard]] std::unique_ptr<NumberArray> in_order_of_frames(std::unique_ptr<NumberArray> array,
                                                              const std::vector<ArrayAxis>& axes);

}  // namespace pillarfield
