#include "io/plain/number_array.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Calls `action` with a value of the C++ type.
template <class Action>
auto with_number(NumberType type, Action action) {
  using Kind = NumberType::Kind;
  if (type.kind == Kind::real) return type.bytes == 4 ? action(float{}) : action(double{});
  const bool is_signed = type.kind == Kind::signed_integer;
  switch (type.bytes) {
    case 1:
      return is_signed ? action(std::int8_t{}) : action(std::uint8_t{});
    case 2:
      return is_signed ? action(std::int16_t{}) : action(std::uint16_t{});
    case 4:
      return is_signed ? action(std::int32_t{}) : action(std::uint32_t{});
    default:
      return is_signed ? action(std::int64_t{}) : action(std::uint64_t{});
  }
}

template <class Number>
Number number_at(const std::byte* numbers, std::size_t index) {
  Number number;
  std::memcpy(&number, numbers + index * sizeof number, sizeof number);
  return number;
}

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

}  // namespace

std::string name_of(NumberType type) {
  using Kind = NumberType::Kind;
  const char* const kind = type.kind == Kind::real             ? "float"
                           : type.kind == Kind::signed_integer ? "int"
                                                               : "uint";
  return fmt::format("{}{}", kind, 8 * type.bytes);
}

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

std::string text_of_shape(const std::vector<std::uint64_t>& shape) {
  return fmt::format("{}", fmt::join(shape, " x "));
}

std::vector<double> read_numbers(NumberArray& array) {
  if (array.shape().size() != 1) {
    throw Error(array.place(), fmt::format("has the shape {}", text_of_shape(array.shape())),
                "times need one dimension");
  }
  const std::size_t count = array.shape()[0];
  std::vector<std::byte> numbers(count * array.type().bytes);
  array.read(0, count, numbers.data());
  std::vector<double> values(count);
  with_number(array.type(), [&]<class Number>(Number) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = static_cast<double>(number_at<Number>(numbers.data(), i));
    }
  });
  return values;
}

std::unique_ptr<NumberArray> array_in_memory(std::string place, NumberType type,
                                             std::vector<std::uint64_t> shape,
                                             std::vector<std::byte> numbers) {
  return std::make_unique<ArrayInMemory>(std::move(place), type, std::move(shape),
                                         std::move(numbers));
}

}  // namespace pillarfield
