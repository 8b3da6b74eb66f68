#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pillarfield {

/// Type of the numbers in an array: an integer of 1, 2, 4 or 8 bytes or a float of 4 or 8.
struct NumberType {
  enum class Kind : std::uint8_t { unsigned_integer, signed_integer, real };
  Kind kind = Kind::unsigned_integer;
  std::size_t bytes = 1;
};

/// "uint8", "int16", "float64".
[[nodiscard]] std::string name_of(NumberType type);

/// "200 x 40 x 60".
[[nodiscard]] std::string text_of_shape(const std::vector<std::uint64_t>& shape);

/// Number `index` of an array in memory, which need not be aligned.
template <class Number>
[[nodiscard]] Number number_at(const std::byte* numbers, std::size_t index) {
  Number number;
  std::memcpy(&number, numbers + index * sizeof number, sizeof number);
  return number;
}

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

/// The numbers of an array in memory.
[[nodiscard]] std::vector<double> doubles_of(NumberType type,
                                             const std::vector<std::byte>& numbers);

}  // namespace pillarfield
