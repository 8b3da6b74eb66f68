#include "simulation/indenter/fourier.h"

#include <algorithm>
#include <kissfft/kissfft.hh>
#include <vector>

namespace pillarfield {

struct Fourier::Plans {
  explicit Plans(std::size_t length) : forward(length, false), inverse(length, true) {}
  kissfft<double> forward;
  kissfft<double> inverse;
};

Fourier::Fourier(std::size_t length) : length_(length), plans_(std::make_unique<Plans>(length)) {}
Fourier::~Fourier() = default;
Fourier::Fourier(Fourier&&) noexcept = default;
Fourier& Fourier::operator=(Fourier&&) noexcept = default;

void Fourier::forward(const Complex* in, Complex* out) const { plans_->forward.transform(in, out); }

void Fourier::inverse(const Complex* in, Complex* out) const { plans_->inverse.transform(in, out); }

std::size_t quick_fourier_length(std::size_t length) {
  for (std::size_t quick = length < 4 ? 4 : length + length % 2;; quick += 2) {
    std::size_t rest = quick;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return quick;
  }
}

void transform_plane(const Fourier& rows, const Fourier& cols, Complex* plane) {
  const std::size_t height = rows.length();
  const std::size_t width = cols.length();
  std::vector<Complex> line(std::max(height, width));
  std::vector<Complex> transformed(line.size());
  for (std::size_t row = 0; row < height; ++row) {
    Complex* const values = plane + row * width;
    cols.forward(values, transformed.data());
    std::copy_n(transformed.begin(), width, values);
  }
  for (std::size_t col = 0; col < width; ++col) {
    for (std::size_t row = 0; row < height; ++row) line[row] = plane[row * width + col];
    rows.forward(line.data(), transformed.data());
    for (std::size_t row = 0; row < height; ++row) plane[row * width + col] = transformed[row];
  }
}

}  // namespace pillarfield
