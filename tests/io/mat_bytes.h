#pragma once

// A writer of MAT-files of version 5 for tests, which shares no code with the reader. It follows
// "MAT-File Format" of The MathWorks.

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pillarfield::io_test {

/// The classes of MATLAB's values, mxCELL_CLASS to mxUINT64_CLASS.
enum class MxClass : std::uint32_t {
  cell = 1,
  structure = 2,
  object = 3,
  text = 4,
  sparse = 5,
  real64 = 6,
  real32 = 7,
  int8 = 8,
  uint8 = 9,
  int16 = 10,
  uint16 = 11,
  int32 = 12,
  uint32 = 13,
  int64 = 14,
  uint64 = 15
};

/// The type of stored numbers, miINT8 to miUINT64.
template <class Number>
constexpr std::uint32_t mi_type() {
  if constexpr (std::is_same_v<Number, float>) return 7;
  if constexpr (std::is_same_v<Number, double>) return 9;
  constexpr bool kSigned = std::is_signed_v<Number>;
  switch (sizeof(Number)) {
    case 1:
      return kSigned ? 1 : 2;
    case 2:
      return kSigned ? 3 : 4;
    case 4:
      return kSigned ? 5 : 6;
    default:
      return kSigned ? 12 : 13;
  }
}

constexpr std::uint32_t kMxComplex = 0x800;
constexpr std::uint32_t kMxLogical = 0x200;

class MatBytes {
 public:
  explicit MatBytes(std::endian order) : order_(order) {}

  [[nodiscard]] std::string header() const {
    std::string text = "MATLAB 5.0 MAT-file, written by a test";
    text.resize(124, ' ');
    return text + number(std::uint16_t{0x0100}) + number(std::uint16_t{0x4d49});
  }

  template <class Number>
  [[nodiscard]] std::string number(Number value) const {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }

  /// An element of that type; up to four bytes lie within its tag, as MATLAB writes them.
  [[nodiscard]] std::string element(std::uint32_t type, std::string data) const {
    const auto size = static_cast<std::uint32_t>(data.size());
    const bool is_small = size > 0 && size <= 4;
    const std::string tag = is_small ? number(size << 16U | type) : number(type) + number(size);
    data.resize(is_small ? 4 : (data.size() + 7) / 8 * 8);
    return tag + data;
  }

  template <class Number>
  [[nodiscard]] std::string numbers(const std::vector<Number>& values) const {
    std::string data;
    for (const Number value : values) data += number(value);
    return element(mi_type<Number>(), data);
  }

  [[nodiscard]] std::string matrix(MxClass kind, const std::vector<std::int32_t>& shape,
                                   const std::string& name, const std::string& content,
                                   std::uint32_t flags = 0) const {
    const std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(kind) | flags, 0};
    return element(14, numbers(words) + numbers(shape) + element(1, name) + content);
  }

  /// An array of MATLAB's class with numbers of another type, column by column.
  template <class Number>
  [[nodiscard]] std::string array(MxClass kind, const std::vector<std::int32_t>& shape,
                                  const std::string& name, const std::vector<Number>& values,
                                  std::uint32_t flags = 0) const {
    return matrix(kind, shape, name, numbers(values), flags);
  }

  [[nodiscard]] std::string compressed(const std::string& variable) const {
    uLongf size = compressBound(variable.size());
    std::string data(size, '\0');
    compress(reinterpret_cast<Bytef*>(data.data()), &size,
             reinterpret_cast<const Bytef*>(variable.data()), variable.size());
    data.resize(size);
    return number(std::uint32_t{15}) + number(static_cast<std::uint32_t>(size)) + data;
  }

 private:
  std::endian order_;
};

}  // namespace pillarfield::io_test
