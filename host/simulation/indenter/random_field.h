#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"

namespace pillarfield {

/// A smooth random function of the plane with a period of 512 spacings: Gaussian noise, a function
/// of seed, stream and number, filtered in the Fourier domain and interpolated linearly.
class RandomField {
 public:
  struct Noise {
    std::uint64_t seed;
    random::Stream stream;
    std::uint64_t number;  ///< of the indenter
  };

  /// Power spectrum ∝ k^(−2 − 2 exponent) for wavelengths from 8 `spacing_mm` to `longest_mm`, at
  /// least one; mean 0, root mean square 1.
  [[nodiscard]] static RandomField self_affine(const Noise& noise, double spacing_mm,
                                               double longest_mm, double exponent);

  /// erf(f/√2) of Gaussian noise f with correlation exp(−(d/length)²): uniform on (−1, 1).
  [[nodiscard]] static RandomField smooth(const Noise& noise, double length_mm);

  [[nodiscard]] double at(double x_mm, double y_mm) const;

 private:
  RandomField(const Noise& noise, double spacing_mm);
  template <class Amplitude>
  void filter(Amplitude amplitude);
  void normalise();
  [[nodiscard]] double value(std::int64_t row, std::int64_t col) const;

  double spacing_mm_;
  std::vector<double> values_;
};

}  // namespace pillarfield
