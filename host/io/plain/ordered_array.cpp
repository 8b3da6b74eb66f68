#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "io/plain/source.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

/// A permutation of three axes: element i of `to` is element `from[i]` of the given array.
struct AxisOrder {
  std::array<std::size_t, 3> from;

  [[nodiscard]] std::vector<std::uint64_t> shape(const std::vector<std::uint64_t>& given) const {
    return {given[from[0]], given[from[1]], given[from[2]]};
  }
};

/// Copies slices of the given array, from `first` on, to their places in the ordered one.
class Scatter {
 public:
  Scatter(const NumberArray& given, const AxisOrder& order)
      : bytes_(given.type().bytes), shape_(given.shape()) {
    std::size_t step = bytes_;
    for (std::size_t axis = 3; axis-- > 0;) {
      steps_[order.from[axis]] = step;
      step *= shape_[order.from[axis]];
    }
  }

  void operator()(const std::byte* slice, std::uint64_t index, std::byte* ordered) const {
    std::byte* const plane = ordered + index * steps_[0];
    for (std::uint64_t i = 0; i < shape_[1]; ++i) {
      for (std::uint64_t j = 0; j < shape_[2]; ++j, slice += bytes_) {
        std::memcpy(plane + i * steps_[1] + j * steps_[2], slice, bytes_);
      }
    }
  }

 private:
  std::size_t bytes_;
  std::vector<std::uint64_t> shape_;
  std::array<std::size_t, 3> steps_ = {};  // bytes in the ordered array
};

/// Frames whose columns come before their rows.
class TransposedFrames final : public NumberArray {
 public:
  TransposedFrames(std::unique_ptr<NumberArray> given, const AxisOrder& order)
      : NumberArray(given->place(), given->type(), order.shape(given->shape())),
        scatter_(*given, order),
        slice_(given->slice_bytes()),
        given_(std::move(given)) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    for (std::uint64_t i = 0; i < count; ++i) {
      given_->read(first + i, 1, slice_.data());
      scatter_(slice_.data(), i, numbers);
    }
  }

 private:
  Scatter scatter_;
  std::vector<std::byte> slice_;
  std::unique_ptr<NumberArray> given_;
};

std::unique_ptr<NumberArray> reordered_in_memory(NumberArray& given, const AxisOrder& order) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;
  constexpr std::uint64_t kMostBatchBytes = std::uint64_t{64} << 20U;
  const std::uint64_t slices = given.shape()[0];
  const std::size_t slice_bytes = given.slice_bytes();
  if (slice_bytes > 0 && slices > kMostBytes / slice_bytes) {
    throw Error(given.place(),
                "is larger than 1 GiB, the most that is read with frames along another axis than "
                "the first",
                "save it with frames first, by numpy.moveaxis");
  }
  const Scatter scatter(given, order);
  std::vector<std::byte> numbers(slices * slice_bytes);
  // Many slices at once, since each of them may lie in all chunks of a file.
  const std::uint64_t batch =
      std::clamp<std::uint64_t>(kMostBatchBytes / std::max<std::size_t>(1, slice_bytes), 1,
                                std::max<std::uint64_t>(1, slices));
  std::vector<std::byte> some(batch * slice_bytes);
  for (std::uint64_t first = 0; first < slices; first += batch) {
    if (is_interrupted())
      throw Error(given.place(), "interrupted while it was read", "start again");
    const std::uint64_t count = std::min(batch, slices - first);
    given.read(first, count, some.data());
    for (std::uint64_t i = 0; i < count; ++i) {
      scatter(some.data() + i * slice_bytes, first + i, numbers.data());
    }
  }
  return array_in_memory(given.place(), given.type(), order.shape(given.shape()),
                         std::move(numbers));
}

/// A single frame whose columns come before its rows.
std::unique_ptr<NumberArray> transposed_frame(NumberArray& given) {
  const std::vector<std::uint64_t> shape = {1, given.shape()[0], given.shape()[1]};
  std::vector<std::byte> numbers(shape[1] * given.slice_bytes());
  given.read(0, shape[1], numbers.data());
  const auto frame = array_in_memory(given.place(), given.type(), shape, std::move(numbers));
  return reordered_in_memory(*frame, {{0, 2, 1}});
}

}  // namespace

std::unique_ptr<NumberArray> in_order_of_frames(std::unique_ptr<NumberArray> array,
                                                const std::vector<ArrayAxis>& axes) {
  if (axes.size() != array->shape().size()) {
    throw Error(array->place(),
                fmt::format("has the shape {}, and {} axes are named",
                            text_of_shape(array->shape()), axes.size()),
                "name each axis of the array, or leave out --axes");
  }
  if (std::ranges::is_sorted(axes)) return array;
  if (axes.size() == 2) return transposed_frame(*array);
  AxisOrder order = {};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    order.from[static_cast<std::size_t>(axes[axis])] = axis;
  }
  if (order.from[0] != 0) return reordered_in_memory(*array, order);
  return std::make_unique<TransposedFrames>(std::move(array), order);
}

}  // namespace pillarfield
