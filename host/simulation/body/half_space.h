#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "simulation/body/cells.h"
#include "simulation/body/fourier.h"

namespace pillarfield {

/// The surface of an incompressible elastic half-space: what tractions that are constant on each
/// cell of a window displace at the cells' middles (Boussinesq, Cerruti and Love;
/// docs/derivations/half_space.md, equations H3 to H6). With ν = 1/2 pressure moves the surface
/// along the normal alone, and shear within its plane alone.
///
/// A traction here is a traction over πE*, E* = 4E/3, so it has no unit and displacements are in
/// millimetres. Convolutions go through Fourier transforms, padded with zeros, so nothing wraps
/// around. An object keeps memory for its work: one thread at a time uses it.
class HalfSpace {
 public:
  /// For windows of up to `rows` by `cols` cells.
  HalfSpace(std::size_t rows, std::size_t cols, double cell_mm);

  [[nodiscard]] bool fits(const CellBox& box) const;

  /// No shear of 1 in every cell moves the surface farther, give or take a rounding.
  [[nodiscard]] double most_shear_mm() const { return most_shear_mm_; }

  /// How far `pressure` presses the surface in. `depth_mm` has the same box.
  void press(const CellField& pressure, CellField& depth_mm);

  /// Where shear (x right, y up) moves the surface. All four have the same box.
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

/// The half-spaces of the sizes that were needed last: their kernels take as long as some ten
/// convolutions.
class HalfSpaces {
 public:
  explicit HalfSpaces(double cell_mm) : cell_mm_(cell_mm) {}

  [[nodiscard]] double cell_mm() const { return cell_mm_; }

  /// One that fits the box; it stays valid until the next call.
  [[nodiscard]] HalfSpace& for_box(const CellBox& box);

 private:
  struct Sized {
    std::size_t rows;
    std::size_t cols;
    std::unique_ptr<HalfSpace> half_space;
  };
  double cell_mm_;
  std::vector<Sized> sized_;  ///< the one used last is last
};

}  // namespace pillarfield
