#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_file.h"
#include "io/plain/array_names.h"
#include "io/plain/number_array.h"

namespace pillarfield {

/// Whether a file begins as a MAT-file of version 5, by its first 128 bytes.
[[nodiscard]] bool is_mat_5(std::string_view head);

/// Whether a file begins as a MAT-file of version 4: with the header of a matrix and its name.
[[nodiscard]] bool is_mat_4(std::string_view head);

/// A variable of a MAT-file: itself stored, or zlib's compression of it.
struct MatVariable {
  std::uint64_t at = 0;  ///< of its tag in the file, or of the compressed bytes
  std::uint64_t bytes = 0;
  bool is_compressed = false;
};

/// An array of real numbers in a MAT-file.
struct MatArray {
  std::string name;  ///< "raw", "pads{3}", "log.raw", "log(2).raw"
  NumberType type;   ///< as stored: MATLAB stores doubles that are small whole numbers as integers
  std::vector<std::uint64_t> shape;  ///< the first axis varies fastest; a vector has one dimension
  std::size_t variable = 0;
  std::uint64_t at = 0;  ///< of the numbers in the variable

  [[nodiscard]] std::uint64_t bytes() const;
};

/// A MAT-file of version 5, written by MATLAB's save -v6 or -v7, Octave or SciPy ("MAT-File
/// Format", The MathWorks). Lists the arrays of real numbers and logicals, also in cells and
/// structs; other values are named by names() and not read.
class MatFile {
 public:
  /// Throws Error if the file is damaged, or holds more than 1000 variables, or compressed cells
  /// and structs beyond most_inflated().
  explicit MatFile(const std::filesystem::path& path);

  [[nodiscard]] const ArrayNames& names() const { return names_; }
  [[nodiscard]] const MatArray& array(std::size_t index) const { return arrays_[index]; }

  /// The array in C order, so with its axes reversed. Throws Error if it is compressed and damaged,
  /// or compressed and larger than most_inflated().
  [[nodiscard]] std::unique_ptr<NumberArray> open(std::size_t index) const;

 private:
  void list_variables();
  [[nodiscard]] std::vector<std::byte> inflated(const MatArray& array,
                                                const std::string& place) const;

  InputFile file_;
  bool is_swapped_ = false;
  std::vector<MatVariable> variables_;
  std::vector<MatArray> arrays_;
  ArrayNames names_;
};

}  // namespace pillarfield
