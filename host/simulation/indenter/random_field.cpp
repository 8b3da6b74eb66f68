#include "simulation/indenter/random_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/indenter/fourier.h"

namespace pillarfield {
namespace {

constexpr std::size_t kFieldSide = 512;

/// Cycles along the side that the k-th number of a transform stands for.
double field_cycles(std::size_t k) {
  const auto cycles = static_cast<double>(k);
  return 2 * k <= kFieldSide ? cycles : cycles - static_cast<double>(kFieldSide);
}

}  // namespace

RandomField::RandomField(const Noise& noise, double spacing_mm)
    : spacing_mm_(spacing_mm), values_(kFieldSide * kFieldSide) {
  std::vector<float> row(kFieldSide);
  for (std::size_t i = 0; i < kFieldSide; ++i) {
    random::fill_normal({noise.seed, noise.stream, noise.number, static_cast<std::uint32_t>(i)},
                        row);
    std::copy(row.begin(), row.end(),
              values_.begin() + static_cast<std::ptrdiff_t>(i * row.size()));
  }
}

/// Multiplies the transform by `amplitude(wave number)`, in 1/mm, and takes it back.
template <class Amplitude>
void RandomField::filter(Amplitude amplitude) {
  const Fourier fourier(kFieldSide);
  std::vector<Complex> plane(values_.begin(), values_.end());
  transform_plane(fourier, fourier, plane.data());
  const double unit = 2 * std::numbers::pi / (static_cast<double>(kFieldSide) * spacing_mm_);
  for (std::size_t row = 0; row < kFieldSide; ++row) {
    for (std::size_t col = 0; col < kFieldSide; ++col) {
      const double k = unit * std::hypot(field_cycles(row), field_cycles(col));
      // The conjugate, so that another transform forwards is the way back.
      plane[row * kFieldSide + col] = std::conj(plane[row * kFieldSide + col]) * amplitude(k);
    }
  }
  transform_plane(fourier, fourier, plane.data());
  std::transform(plane.begin(), plane.end(), values_.begin(),
                 [](const Complex& value) { return value.real(); });
}

/// Makes the root mean square 1.
void RandomField::normalise() {
  double squares = 0;
  for (const double value : values_) squares += value * value;
  const double rms = std::sqrt(squares / static_cast<double>(values_.size()));
  for (double& value : values_) value /= rms;
}

RandomField RandomField::self_affine(const Noise& noise, double spacing_mm, double longest_mm,
                                     double exponent) {
  RandomField field(noise, spacing_mm);
  const double shortest_mm = 8 * spacing_mm;
  const double high = 2 * std::numbers::pi / shortest_mm;
  const double side_mm = static_cast<double>(kFieldSide) * spacing_mm;
  const double low = 2 * std::numbers::pi / std::clamp(longest_mm, 1.25 * shortest_mm, side_mm);
  field.filter([=](double k) {
    return k >= low * (1 - 1e-9) && k <= high ? std::pow(k / low, -1 - exponent) : 0.0;
  });
  field.normalise();
  return field;
}

RandomField RandomField::smooth(const Noise& noise, double length_mm) {
  RandomField field(noise, length_mm / 8);
  field.filter([=](double k) { return k > 0 ? std::exp(-k * k * length_mm * length_mm / 8) : 0; });
  field.normalise();
  for (double& value : field.values_) value = std::erf(value / std::numbers::sqrt2);
  return field;
}

double RandomField::value(std::int64_t row, std::int64_t col) const {
  constexpr auto kSide = static_cast<std::int64_t>(kFieldSide);
  const std::int64_t r = ((row % kSide) + kSide) % kSide;
  const std::int64_t c = ((col % kSide) + kSide) % kSide;
  return values_[static_cast<std::size_t>(r * kSide + c)];
}

double RandomField::at(double x_mm, double y_mm) const {
  const double x = x_mm / spacing_mm_;
  const double y = y_mm / spacing_mm_;
  const double left = std::floor(x);
  const double low = std::floor(y);
  const auto col = static_cast<std::int64_t>(left);
  const auto row = static_cast<std::int64_t>(low);
  return std::lerp(std::lerp(value(row, col), value(row, col + 1), x - left),
                   std::lerp(value(row + 1, col), value(row + 1, col + 1), x - left), y - low);
}

}  // namespace pillarfield
