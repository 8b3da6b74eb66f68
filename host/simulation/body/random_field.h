#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"

namespace pillarfield {

/// A smooth random function of the plane, which repeats after 512 spacings: Gaussian noise, a
/// function of seed, stream and number, that is filtered in the Fourier domain and interpolated
/// linearly.
class RandomField {
 public:
  struct Noise {
    std::uint64_t seed;
    random::Stream stream;
    std::uint64_t number;  ///< of the body
  };

  /// Power spectrum ~ k^(−2 − 2 exponent) for wavelengths from 8 `spacing_mm` to `longest_mm`, none
  /// beyond; mean 0, root mean square 1. A single wavelength is left where there would be none.
  [[nodiscard]] static RandomField self_affine(const Noise& noise, double spacing_mm,
                                               double longest_mm, double exponent);

  /// Gaussian noise f correlated as exp(−(d/length)²), made even: erf(f/√2), so that every value
  /// between −1 and 1 is as likely.
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
