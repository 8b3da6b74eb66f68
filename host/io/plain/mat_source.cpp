// Frames of MATLAB: .mat files of version 5. Those of version 7.3 are HDF5.

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/frame_source.h"
#include "io/plain/inflater.h"
#include "io/plain/mat_file.h"
#include "io/plain/source.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A plane with its rows as the first axis, of one that is stored column by column.
std::unique_ptr<NumberArray> by_rows(std::unique_ptr<NumberArray> plane) {
  using enum ArrayAxis;
  const std::vector<std::uint64_t> shape = {plane->shape()[1], plane->shape()[0]};
  if (shape[1] > kMostInflatedBytes / (shape[0] * plane->type().bytes)) {
    throw Error(plane->place(), "is larger than 1 GiB, the most that is read of two dimensions",
                "save it with three, rows x columns x frames");
  }
  const auto frame = in_order_of_frames(std::move(plane), {columns, rows});
  std::vector<std::byte> numbers(frame->slice_bytes());
  frame->read(0, 1, numbers.data());
  return array_in_memory(frame->place(), frame->type(), shape, std::move(numbers));
}

/// The source of an array whose axes MATLAB has in the reverse order.
std::unique_ptr<FileSource> source_by_columns(const std::filesystem::path& path,
                                              std::unique_ptr<NumberArray> array,
                                              std::vector<double> times_s,
                                              const ReadOptions& options) {
  using enum ArrayAxis;
  constexpr const char* kFormat = "MATLAB file";
  if (array->shape().size() == 2) {
    return array_source(path, kFormat, by_rows(std::move(array)), std::move(times_s), options);
  }
  std::vector<ArrayAxis> axes =
      options.axes.empty() ? std::vector{frames, rows, columns} : options.axes;
  std::ranges::reverse(axes);
  std::vector<std::uint64_t> shape = array->shape();
  std::ranges::reverse(shape);
  if (shape.size() != axes.size()) {
    throw Error(array->place(), fmt::format("has the shape {}", text_of_shape(shape)),
                options.axes.empty() ? "frames need the shape (frames, rows, columns)"
                                     : "name each axis of the array, or leave out --axes");
  }
  ReadOptions ordered = options;
  if (!ordered.axes.empty()) ordered.axes = {frames, rows, columns};
  return array_source(path, kFormat, in_order_of_frames(std::move(array), axes), std::move(times_s),
                      ordered);
}

std::unique_ptr<FileSource> open_mat(const std::filesystem::path& path,
                                     const ReadOptions& options) {
  if (!is_mat_5(InputFile(path).text_at(0, 128))) {
    throw Error(path.string(), "is a MATLAB file of version 4", "save it with -v7");
  }
  const MatFile file(path);
  std::unique_ptr<NumberArray> readings = file.open(file.names().array_of_frames(options.dataset));
  std::vector<double> times_s;
  const auto times = file.names().array_of_times(options.times);
  if (times) times_s = read_numbers(*file.open(*times));
  return source_by_columns(path, std::move(readings), std::move(times_s), options);
}

}  // namespace

SourceFormat mat_format() {
  return {.name = "MATLAB file (.mat)",
          .recognises = [](std::string_view head) { return is_mat_5(head) || is_mat_4(head); },
          .open = open_mat};
}

}  // namespace pillarfield
