#pragma once

#include <complex>
#include <cstddef>
#include <memory>

namespace pillarfield {

using Complex = std::complex<double>;

/// Discrete Fourier transforms of one length, a product of powers of 2, 3 and 5. Unnormalised:
/// forward and inverse together multiply by the length. Thread-safe.
class Fourier {
 public:
  explicit Fourier(std::size_t length);
  ~Fourier();
  Fourier(Fourier&&) noexcept;
  Fourier& operator=(Fourier&&) noexcept;

  [[nodiscard]] std::size_t length() const { return length_; }
  /// Forward, exp(−2πi jk/n); `in` and `out` are distinct arrays of length().
  void forward(const Complex* in, Complex* out) const;
  /// Inverse, exp(+2πi jk/n).
  void inverse(const Complex* in, Complex* out) const;

 private:
  struct Plans;
  std::size_t length_;
  std::unique_ptr<const Plans> plans_;
};

/// The least even product of powers of 2, 3 and 5 that is at least `length`.
[[nodiscard]] std::size_t quick_fourier_length(std::size_t length);

/// Transforms a plane of `rows.length()` rows and `cols.length()` columns forwards, in place.
void transform_plane(const Fourier& rows, const Fourier& cols, Complex* plane);

}  // namespace pillarfield
