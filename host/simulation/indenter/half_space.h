#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "simulation/indenter/cells.h"
#include "simulation/indenter/fourier.h"

namespace pillarfield {

/// Surface displacements of an incompressible elastic half-space at cell centres under tractions
/// constant on each cell (Boussinesq, Cerruti and Love; docs/derivations/half_space.md, H3 to H6).
/// With ν = 1/2 pressure causes normal and shear tangential displacement only.
///
/// Tractions are divided by πE*, E* = 4E/3, and have no unit; displacements are in mm. Convolutions
/// use zero-padded Fourier transforms. Not thread-safe: an object holds work memory.
class HalfSpace {
 public:
  /// For windows of up to `rows` by `cols` cells.
  HalfSpace(std::size_t rows, std::size_t cols, double cell_mm);

  [[nodiscard]] bool fits(const CellBox& box) const;

  /// Upper bound, up to rounding, of the displacement by shear of magnitude 1 in every cell.
  [[nodiscard]] double most_shear_mm() const { return most_shear_mm_; }

  /// Normal displacement `depth_mm` under `pressure`, in one box.
  void press(const CellField& pressure, CellField& depth_mm);

  /// Tangential displacement under shear (x right, y up). All four have one box.
  void shear(const CellField& x, const CellField& y, CellField& x_mm, CellField& y_mm);

 private:
  using Spectrum = std::vector<Complex>;  ///< [half of the columns, rows of the window]

  void transform_kernels(double cell_mm);
  void rows_forward(const double* a, const double* b, std::size_t cols, Complex* a_spectrum,
                    Complex* b_spectrum, std::size_t stride);
  void rows_inverse(const Complex* a_spectrum, const Complex* b_spectrum, std::size_t stride,
                    double* a, double* b, std::size_t cols);
  void column_forward(const Complex* column, std::size_t rows, Spectrum& transformed);
  void column_inverse(const Spectrum& transformed, Complex* column, std::size_t rows);
  [[nodiscard]] std::size_t spectrum_cols() const { return cols_.length() / 2 + 1; }

  Fourier rows_;
  Fourier cols_;
  /// Transforms of the kernels, all real: [half of the columns, rows].
  std::vector<double> normal_;
  std::vector<double> shear_xx_;
  std::vector<double> shear_yy_;
  std::vector<double> shear_xy_;
  double most_shear_mm_ = 0;
  Spectrum first_;
  Spectrum second_;
  Spectrum line_;
  Spectrum line_out_;
  Spectrum column_;
  Spectrum column_x_;
  Spectrum column_y_;
};

/// Cache of half-spaces by size: computing the kernels costs about ten convolutions.
class HalfSpaces {
 public:
  explicit HalfSpaces(double cell_mm) : cell_mm_(cell_mm) {}

  [[nodiscard]] double cell_mm() const { return cell_mm_; }

  /// A half-space that fits the box; valid until the next call.
  [[nodiscard]] HalfSpace& for_box(const CellBox& box);

 private:
  struct Sized {
    std::size_t rows;
    std::size_t cols;
    std::unique_ptr<HalfSpace> half_space;
  };
  double cell_mm_;
  std::vector<Sized> sized_;  ///< least recently used first
};

}  // namespace pillarfield
