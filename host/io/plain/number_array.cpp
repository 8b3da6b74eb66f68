#include "io/plain/number_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/npy.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

template <class Number>
bool is_exact(Number number) {
  if constexpr (std::numeric_limits<Number>::is_integer && sizeof(Number) > 2) {
    constexpr Number kMost = 1 << std::numeric_limits<float>::digits;
    return number <= kMost && (std::numeric_limits<Number>::is_signed ? number + kMost >= 0 : true);
  }
  return true;
}

template <class Number>
float float_of(Number number) {
  if constexpr (sizeof(Number) == 8 && !std::numeric_limits<Number>::is_integer) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    if (std::abs(number) > std::numeric_limits<float>::max())
      return number > 0 ? kInfinite : -kInfinite;
  }
  return static_cast<float>(number);
}

class ArrayInMemory final : public NumberArray {
 public:
  ArrayInMemory(std::string place, NumberType type, std::vector<std::uint64_t> shape,
                std::vector<std::byte> numbers)
      : NumberArray(std::move(place), type, std::move(shape)), numbers_(std::move(numbers)) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    if (count == 0 || slice_bytes() == 0) return;
    std::memcpy(numbers, numbers_.data() + first * slice_bytes(), count * slice_bytes());
  }

 private:
  std::vector<std::byte> numbers_;
};

class ArrayInFile final : public NumberArray {
 public:
  ArrayInFile(InputFile file, std::uint64_t at, bool is_swapped, std::string place, NumberType type,
              std::vector<std::uint64_t> shape)
      : NumberArray(std::move(place), type, std::move(shape)),
        file_(std::move(file)),
        at_(at),
        is_swapped_(is_swapped) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    const std::size_t bytes = count * slice_bytes();
    file_.read(at_ + first * slice_bytes(), {numbers, bytes});
    if (is_swapped_) swap_bytes(numbers, bytes / type().bytes, type().bytes);
  }

 private:
  InputFile file_;
  std::uint64_t at_;
  bool is_swapped_;
};

}  // namespace

SenselType sensel_type_for(NumberType type) {
  if (type.kind != NumberType::Kind::unsigned_integer || type.bytes > 2) return SenselType::f32;
  return type.bytes == 1 ? SenselType::u8 : SenselType::u16;
}

std::optional<std::size_t> convert_to_readings(NumberType type, const std::byte* numbers,
                                               std::size_t count, std::byte* readings) {
  if (sensel_type_for(type) != SenselType::f32) {
    std::memcpy(readings, numbers, count * type.bytes);
    return std::nullopt;
  }
  return with_number(type, [&]<class Number>(Number) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = number_at<Number>(numbers, i);
      if (!is_exact(number)) return i;
      const float reading = float_of(number);
      std::memcpy(readings + i * sizeof reading, &reading, sizeof reading);
    }
    return std::nullopt;
  });
}

std::size_t NumberArray::slice_bytes() const {
  std::size_t bytes = type_.bytes;
  for (std::size_t d = 1; d < shape_.size(); ++d) bytes *= shape_[d];
  return bytes;
}

std::vector<double> read_numbers(NumberArray& array) {
  std::uint64_t count = 1;
  for (const std::uint64_t size : array.shape()) count *= size;
  if (std::ranges::count_if(array.shape(), [](auto size) { return size != 1; }) > 1) {
    throw Error(array.place(), fmt::format("has the shape {}", text_of_shape(array.shape())),
                "times need one dimension");
  }
  std::vector<std::byte> numbers(count * array.type().bytes);
  array.read(0, array.shape()[0], numbers.data());
  return doubles_of(array.type(), numbers);
}

std::unique_ptr<NumberArray> array_in_memory(std::string place, NumberType type,
                                             std::vector<std::uint64_t> shape,
                                             std::vector<std::byte> numbers) {
  return std::make_unique<ArrayInMemory>(std::move(place), type, std::move(shape),
                                         std::move(numbers));
}

std::unique_ptr<NumberArray> array_in_file(InputFile file, std::uint64_t at, bool is_swapped,
                                           std::string place, NumberType type,
                                           std::vector<std::uint64_t> shape) {
  return std::make_unique<ArrayInFile>(std::move(file), at, is_swapped, std::move(place), type,
                                       std::move(shape));
}

}  // namespace pillarfield
