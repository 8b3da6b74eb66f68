#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_type.h"

namespace pillarfield {

/// Header of NumPy's format NPY, versions 1 to 3
/// (https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html).
struct NpyHeader {
  NumberType type;
  bool is_boolean = false;  ///< of one byte, 0 or 1
  bool is_swapped = false;  ///< the byte order is not that of the host
  bool by_columns = false;  ///< Fortran order
  std::vector<std::uint64_t> shape;
  std::uint64_t bytes = 0;       ///< of the header
  std::uint64_t data_bytes = 0;  ///< of the numbers
};

inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// Longest header that is read, bytes.
inline constexpr std::size_t kLongestNpyHeader = std::size_t{64} << 10;

/// Parses the header at the beginning of `head`, the first kLongestNpyHeader bytes of an array.
/// Throws Error, naming `place`, if it is damaged or its numbers are not of a type that is read.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view head, const std::string& place);

/// Reverses the bytes of each number.
void swap_bytes(std::byte* numbers, std::size_t count, std::size_t number_bytes);

}  // namespace pillarfield
