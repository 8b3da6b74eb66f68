#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/input_file.h"
#include "base/number_type.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// The type of readings for numbers of a type: uint8, uint16 and float32 stay, others become
/// float32.
[[nodiscard]] SenselType sensel_type_for(NumberType type);

/// Converts `count` numbers to readings of sensel_type_for(type). A float64 beyond float32 becomes
/// infinite, which is a missing reading. Returns the index of the first integer beyond ±2^24, which
/// float32 does not hold exactly; unset if there is none.
[[nodiscard]] std::optional<std::size_t> convert_to_readings(NumberType type,
                                                             const std::byte* numbers,
                                                             std::size_t count,
                                                             std::byte* readings);

/// An array of numbers in a file, in C order. A slice is an element of its first dimension.
class NumberArray {
 public:
  NumberArray(std::string place, NumberType type, std::vector<std::uint64_t> shape)
      : place_(std::move(place)), type_(type), shape_(std::move(shape)) {}
  virtual ~NumberArray() = default;
  NumberArray(const NumberArray&) = delete;
  NumberArray& operator=(const NumberArray&) = delete;

  /// "frames.npz: raw", for messages.
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] NumberType type() const { return type_; }
  /// At least one dimension.
  [[nodiscard]] const std::vector<std::uint64_t>& shape() const { return shape_; }
  [[nodiscard]] std::size_t slice_bytes() const;

  /// Copies `count` slices from `first` on, in the byte order of the host.
  virtual void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) = 0;

 private:
  std::string place_;
  NumberType type_;
  std::vector<std::uint64_t> shape_;
};

/// Reads a one-dimensional array of any type, such as [N] or [N, 1]. Throws Error if it has more
/// dimensions.
[[nodiscard]] std::vector<double> read_numbers(NumberArray& array);

/// An array in memory.
[[nodiscard]] std::unique_ptr<NumberArray> array_in_memory(std::string place, NumberType type,
                                                           std::vector<std::uint64_t> shape,
                                                           std::vector<std::byte> numbers);

/// An array whose numbers follow each other from byte `at` of a file on; they are read when they
/// are asked for. With `is_swapped`, their byte order is not that of the host.
[[nodiscard]] std::unique_ptr<NumberArray> array_in_file(InputFile file, std::uint64_t at,
                                                         bool is_swapped, std::string place,
                                                         NumberType type,
                                                         std::vector<std::uint64_t> shape);

}  // namespace pillarfield
