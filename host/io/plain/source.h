#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "io/file_source.h"
#include "io/plain/number_array.h"
#include "pillarfield/array_axes.h"

namespace pillarfield {

/// Frames in an array of numbers: [frames, rows, cols] or as ReadOptions::axes say, [rows, cols] as
/// one frame, or [frames, rows · cols] with ReadOptions::frame_size. `times_s` is empty if the file
/// has none. Throws Error if the array is of another shape or the times do not fit.
[[nodiscard]] std::unique_ptr<FileSource> array_source(const std::filesystem::path& path,
                                                       std::string format,
                                                       std::unique_ptr<NumberArray> readings,
                                                       std::vector<double> times_s,
                                                       const ReadOptions& options);

/// The array with its axes in the order frames, rows, columns; `axes` is their order in `array`.
/// Holds all numbers in memory unless the first axis counts frames. Throws Error if the array has
/// another number of axes, or needs more than 1 GiB.
[[nodiscard]] std::unique_ptr<NumberArray> in_order_of_frames(std::unique_ptr<NumberArray> array,
                                                              const std::vector<ArrayAxis>& axes);

}  // namespace pillarfield
