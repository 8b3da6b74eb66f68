#pragma once

// A writer of little-endian MAT-files of version 5 for tests, which shares no code with the reader.
// It follows "MAT-File Format" of The MathWorks.

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pillarfield::io_test::mat {

/// The classes of MATLAB's values, mxCELL_CLASS to mxUINT64_CLASS.
enum class MxClass : std::uint32_t {
  cell = 1,
  structure = 2,
  text = 4,
  sparse = 5,
  real64 = 6,
  real32 = 7,
  uint8 = 9,
  int16 = 10,
  uint16 = 11
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

template <class Number>
[[nodiscard]] inline std::string number(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

[[nodiscard]] inline std::string header() {
  std::string text = "MATLAB 5.0 MAT-file, written by a test";
  text.resize(124, ' ');
  return text + number(std::uint16_t{0x0100}) + number(std::uint16_t{0x4d49});
}

/// An element of that type; up to four bytes lie within its tag, as MATLAB writes them.
[[nodiscard]] inline std::string element(std::uint32_t type, std::string data) {
  const auto size = static_cast<std::uint32_t>(data.size());
  const bool is_small = size > 0 && size <= 4;
  const std::string tag = is_small ? number(size << 16U | type) : number(type) + number(size);
  data.resize(is_small ? 4 : (data.size() + 7) / 8 * 8);
  return tag + data;
}

template <class Number>
[[nodiscard]] inline std::string numbers(const std::vector<Number>& values) {
  std::string data;
  for (const Number value : values) data += number(value);
  return element(mi_type<Number>(), data);
}

[[nodiscard]] inline std::string matrix(MxClass kind, const std::vector<std::int32_t>& shape,
                                        const std::string& name, const std::string& content,
                                        std::uint32_t flags = 0) {
  const std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(kind) | flags, 0};
  return element(14, numbers(words) + numbers(shape) + element(1, name) + content);
}

/// An array of MATLAB's class with numbers of another type, column by column.
template <class Number>
[[nodiscard]] inline std::string array(MxClass kind, const std::vector<std::int32_t>& shape,
                                       const std::string& name, const std::vector<Number>& values,
                                       std::uint32_t flags = 0) {
  return matrix(kind, shape, name, numbers(values), flags);
}

[[nodiscard]] inline std::string compressed(const std::string& variable) {
  uLongf size = compressBound(variable.size());
  std::string data(size, '\0');
  compress(reinterpret_cast<Bytef*>(data.data()), &size,
           reinterpret_cast<const Bytef*>(variable.data()), variable.size());
  data.resize(size);
  return number(std::uint32_t{15}) + number(static_cast<std::uint32_t>(size)) + data;
}
}  // namespace pillarfield::io_test::mat
