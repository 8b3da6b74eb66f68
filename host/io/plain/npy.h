#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_file.h"
#include "io/plain/number_array.h"

namespace pillarfield {

/// Header of NumPy's format NPY, versions 1 to 3
/// (https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html).
struct NpyHeader {
  NumberType type;
  bool is_swapped = false;  ///< the byte order is not that of the host
  std::vector<std::uint64_t> shape;
  std::uint64_t bytes = 0;       ///< of the header
  std::uint64_t data_bytes = 0;  ///< of the numbers
};

inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// Longest header that is read, bytes.
inline constexpr std::size_t kLongestNpyHeader = std::size_t{64} << 10;

/// Parses the header at the beginning of `head`, the first kLongestNpyHeader bytes of an array.
/// Throws Error, naming `place`, if it is damaged, its numbers are of no type that is read, or they
/// lie in Fortran order.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view head, const std::string& place);

/// Reverses the bytes of each number.
void swap_bytes(std::byte* numbers, std::size_t count, std::size_t number_bytes);

/// The array at `offset` of a file, whose data are read when they are asked for. Throws Error if
/// the file is shorter than the header says; `available` is the largest size, header included.
[[nodiscard]] std::unique_ptr<NumberArray> npy_in_file(InputFile file, std::uint64_t offset,
                                                       std::uint64_t available, std::string place);

}  // namespace pillarfield
