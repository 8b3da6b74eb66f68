#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace pillarfield {

// Logarithm and exponential without branches, which compilers vectorise. Relative error: 1e-12.

/// e to the power of `x`, clamped to [-708, 709].
inline double fast_exp(double x) {
  constexpr double kRound = 0x1.8p52;  // added to a number, its low bits are the nearest integer
  constexpr double kLog2E = 1.4426950408889634;
  constexpr double kLn2High = 0x1.62e42fee00000p-1;
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  x = std::min(std::max(x, -708.0), 709.0);
  const double shifted = x * kLog2E + kRound;
  const double power = shifted - kRound;
  const double r = (x - power * kLn2High) - power * kLn2Low;
  constexpr std::array kInverseFactorials = {1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                                             1.0 / 720,     1.0 / 120,    1.0 / 24,    1.0 / 6,
                                             0.5,           1.0};
  double sum = kInverseFactorials[0];
  for (std::size_t i = 1; i < kInverseFactorials.size(); ++i) sum = sum * r + kInverseFactorials[i];
  const auto scale = (std::bit_cast<std::uint64_t>(shifted) << 52U) + (std::uint64_t{1023} << 52U);
  return (1 + r * sum) * std::bit_cast<double>(scale);
}

/// Natural logarithm of a normal number above zero.
inline double fast_log(double x) {
  constexpr std::uint64_t kOne = std::uint64_t{1023} << 52U;
  constexpr std::uint64_t kExponent = std::uint64_t{0xfff} << 52U;
  constexpr auto kRootOfHalf = std::bit_cast<std::uint64_t>(0.70710678118654757);
  constexpr double kInteger = 0x1p52;  // its low bits are an integer
  constexpr double kLn2 = 0.69314718055994531;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t biased = bits - kRootOfHalf + kOne;  // its exponent is that of the result
  const auto mantissa = std::bit_cast<double>(bits - (biased & kExponent) + kOne);
  const double exponent =
      std::bit_cast<double>((biased >> 52U) | std::bit_cast<std::uint64_t>(kInteger)) -
      (kInteger + 1023);
  const double f = (mantissa - 1) / (mantissa + 1);
  const double s = f * f;
  double sum = 1.0 / 15;
  for (const double term : {1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0})
    sum = sum * s + term;
  return exponent * kLn2 + 2 * f * sum;
}

}  // namespace pillarfield
