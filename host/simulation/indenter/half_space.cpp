#include "simulation/indenter/half_space.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {
namespace {

/// Indefinite integrals over a cell of the three kernels (H4): their second differences at a
/// cell's corners are the integrals.
struct CornerIntegrals {
  std::vector<double> xx;  ///< of x²/r³
  std::vector<double> yy;  ///< of y²/r³
  std::vector<double> xy;  ///< of xy/r³
};

/// At the corners (col − 1/2, row − 1/2) for rows and columns from 0, in cells.
CornerIntegrals kernel_corners(std::size_t rows, std::size_t cols) {
  CornerIntegrals corners;
  for (std::vector<double>* values : {&corners.xx, &corners.yy, &corners.xy}) {
    values->reserve(rows * cols);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double y = static_cast<double>(row) - 0.5;
    for (std::size_t col = 0; col < cols; ++col) {
      const double x = static_cast<double>(col) - 0.5;
      const double r = std::sqrt(x * x + y * y);
      corners.xx.push_back(y * std::log(x + r));
      corners.yy.push_back(x * std::log(y + r));
      corners.xy.push_back(-r);
    }
  }
  return corners;
}

double over_cell(const std::vector<double>& corners, std::size_t row, std::size_t col,
                 std::size_t cols) {
  const double* const upper = &corners[row * cols + col];
  const double* const lower = upper + cols;
  return (lower[1] - lower[0]) - (upper[1] - upper[0]);
}

/// Sets the four places that are `row` and `col` from the origin; the sign changes with that of
/// either where `sign` is −1.
void mirror(std::vector<Complex>& plane, std::size_t height, std::size_t width, std::size_t row,
            std::size_t col, Complex value, double sign) {
  const std::size_t other_row = (height - row) % height;
  const std::size_t other_col = (width - col) % width;
  plane[row * width + col] = value;
  plane[other_row * width + col] = sign * value;
  plane[row * width + other_col] = sign * value;
  plane[other_row * width + other_col] = value;
}

/// Rounds window lengths up, so that steps of a path share kernels.
std::size_t stepped_length(std::int64_t cells) {
  std::size_t step = 8;
  while (static_cast<std::int64_t>(16 * step) < cells) step *= 2;
  const auto length = static_cast<std::size_t>(cells);
  return (length + step - 1) / step * step;
}

}  // namespace

HalfSpace::HalfSpace(std::size_t rows, std::size_t cols, double cell_mm)
    : rows_(quick_fourier_length(2 * rows)),
      cols_(quick_fourier_length(2 * cols)),
      line_(cols_.length()),
      line_out_(cols_.length()),
      column_(rows_.length()),
      column_x_(rows_.length()),
      column_y_(rows_.length()) {
  transform_kernels(cell_mm);
}

bool HalfSpace::fits(const CellBox& box) const {
  return 2 * box.rows <= static_cast<std::int64_t>(rows_.length()) &&
         2 * box.cols <= static_cast<std::int64_t>(cols_.length());
}

void HalfSpace::transform_kernels(double cell_mm) {
  const std::size_t height = rows_.length();
  const std::size_t width = cols_.length();
  const std::size_t corner_cols = width / 2 + 1;
  const CornerIntegrals corners = kernel_corners(height / 2 + 1, corner_cols);
  // xx and yy are even in both directions, so their transforms are real and go as one plane.
  std::vector<Complex> even(height * width);
  std::vector<Complex> odd(height * width);
  for (std::size_t row = 0; row < height / 2; ++row) {
    for (std::size_t col = 0; col < width / 2; ++col) {
      mirror(even, height, width, row, col,
             {over_cell(corners.xx, row, col, corner_cols),
              over_cell(corners.yy, row, col, corner_cols)},
             1);
      // Rows count downwards and y upwards, hence the sign. On the axes it is zero.
      const double xy = row == 0 || col == 0 ? 0 : -over_cell(corners.xy, row, col, corner_cols);
      mirror(odd, height, width, row, col, xy, -1);
    }
  }
  transform_plane(rows_, cols_, even.data());
  transform_plane(rows_, cols_, odd.data());
  const double scale = cell_mm / static_cast<double>(height * width);
  most_shear_mm_ = cell_mm * (even[0].real() + even[0].imag()) * 1.5;
  for (std::vector<double>* kernel : {&normal_, &shear_xx_, &shear_yy_, &shear_xy_}) {
    kernel->resize(spectrum_cols() * height);
  }
  for (std::size_t col = 0; col < spectrum_cols(); ++col) {
    for (std::size_t row = 0; row < height; ++row) {
      const std::size_t at = col * height + row;
      const double xx = scale * even[row * width + col].real();
      const double yy = scale * even[row * width + col].imag();
      normal_[at] = xx + yy;
      shear_xx_[at] = 2 * xx + yy;
      shear_yy_[at] = xx + 2 * yy;
      shear_xy_[at] = scale * odd[row * width + col].real();
    }
  }
}

/// Two real rows are the real and the imaginary part of one complex row.
void HalfSpace::rows_forward(const double* a, const double* b, std::size_t cols,
                             Complex* a_spectrum, Complex* b_spectrum, std::size_t stride) {
  for (std::size_t col = 0; col < cols; ++col) line_[col] = {a[col], b ? b[col] : 0};
  std::fill(line_.begin() + static_cast<std::ptrdiff_t>(cols), line_.end(), Complex());
  cols_.forward(line_.data(), line_out_.data());
  const std::size_t length = cols_.length();
  for (std::size_t k = 0; k < spectrum_cols(); ++k) {
    const Complex z = line_out_[k];
    const Complex mirrored = std::conj(line_out_[k == 0 ? 0 : length - k]);
    a_spectrum[k * stride] = 0.5 * (z + mirrored);
    const Complex difference = 0.5 * (z - mirrored);
    if (b) b_spectrum[k * stride] = {difference.imag(), -difference.real()};
  }
}

void HalfSpace::rows_inverse(const Complex* a_spectrum, const Complex* b_spectrum,
                             std::size_t stride, double* a, double* b, std::size_t cols) {
  const std::size_t length = cols_.length();
  for (std::size_t k = 0; k < spectrum_cols(); ++k) {
    const Complex first = a_spectrum[k * stride];
    const Complex second = b ? b_spectrum[k * stride] : Complex();
    line_[k] = {first.real() - second.imag(), first.imag() + second.real()};
    if (k == 0 || 2 * k == length) continue;
    line_[length - k] = {first.real() + second.imag(), second.real() - first.imag()};
  }
  cols_.inverse(line_.data(), line_out_.data());
  for (std::size_t col = 0; col < cols; ++col) a[col] = line_out_[col].real();
  if (!b) return;
  for (std::size_t col = 0; col < cols; ++col) b[col] = line_out_[col].imag();
}

void HalfSpace::column_forward(const Complex* column, std::size_t rows, Spectrum& transformed) {
  std::copy_n(column, rows, column_.begin());
  std::fill(column_.begin() + static_cast<std::ptrdiff_t>(rows), column_.end(), Complex());
  rows_.forward(column_.data(), transformed.data());
}

void HalfSpace::column_inverse(const Spectrum& transformed, Complex* column, std::size_t rows) {
  rows_.inverse(transformed.data(), column_.data());
  std::copy_n(column_.begin(), rows, column);
}

void HalfSpace::press(const CellField& pressure, CellField& depth_mm) {
  const auto rows = static_cast<std::size_t>(pressure.box.rows);
  const auto cols = static_cast<std::size_t>(pressure.box.cols);
  first_.resize(spectrum_cols() * rows);
  for (std::size_t row = 0; row < rows; row += 2) {
    const double* const values = &pressure.values[row * cols];
    const bool paired = row + 1 < rows;
    rows_forward(values, paired ? values + cols : nullptr, cols, &first_[row],
                 paired ? &first_[row + 1] : nullptr, rows);
  }
  const std::size_t height = rows_.length();
  for (std::size_t col = 0; col < spectrum_cols(); ++col) {
    column_forward(&first_[col * rows], rows, column_x_);
    const double* const kernel = &normal_[col * height];
    for (std::size_t row = 0; row < height; ++row) column_x_[row] *= kernel[row];
    column_inverse(column_x_, &first_[col * rows], rows);
  }
  for (std::size_t row = 0; row < rows; row += 2) {
    double* const values = &depth_mm.values[row * cols];
    const bool paired = row + 1 < rows;
    rows_inverse(&first_[row], paired ? &first_[row + 1] : nullptr, rows, values,
                 paired ? values + cols : nullptr, cols);
  }
}

void HalfSpace::shear(const CellField& x, const CellField& y, CellField& x_mm, CellField& y_mm) {
  const auto rows = static_cast<std::size_t>(x.box.rows);
  const auto cols = static_cast<std::size_t>(x.box.cols);
  first_.resize(spectrum_cols() * rows);
  second_.resize(first_.size());
  for (std::size_t row = 0; row < rows; ++row) {
    rows_forward(&x.values[row * cols], &y.values[row * cols], cols, &first_[row], &second_[row],
                 rows);
  }
  const std::size_t height = rows_.length();
  for (std::size_t col = 0; col < spectrum_cols(); ++col) {
    column_forward(&first_[col * rows], rows, column_x_);
    column_forward(&second_[col * rows], rows, column_y_);
    const std::size_t at = col * height;
    for (std::size_t row = 0; row < height; ++row) {
      const Complex from_x = column_x_[row];
      const Complex from_y = column_y_[row];
      const double xy = shear_xy_[at + row];
      column_x_[row] = shear_xx_[at + row] * from_x + xy * from_y;
      column_y_[row] = xy * from_x + shear_yy_[at + row] * from_y;
    }
    column_inverse(column_x_, &first_[col * rows], rows);
    column_inverse(column_y_, &second_[col * rows], rows);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    rows_inverse(&first_[row], &second_[row], rows, &x_mm.values[row * cols],
                 &y_mm.values[row * cols], cols);
  }
}

HalfSpace& HalfSpaces::for_box(const CellBox& box) {
  constexpr std::size_t kMostKept = 8;
  const std::size_t rows = stepped_length(box.rows);
  const std::size_t cols = stepped_length(box.cols);
  const auto known = std::find_if(sized_.begin(), sized_.end(), [&](const Sized& sized) {
    return sized.rows == rows && sized.cols == cols;
  });
  if (known != sized_.end()) {
    std::rotate(known, known + 1, sized_.end());
  } else {
    if (sized_.size() == kMostKept) sized_.erase(sized_.begin());
    sized_.push_back({rows, cols, std::make_unique<HalfSpace>(rows, cols, cell_mm_)});
  }
  return *sized_.back().half_space;
}

}  // namespace pillarfield
