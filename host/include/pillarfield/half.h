#pragma once

#include <cstdint>

namespace pillarfield {

/// An IEEE half-precision number as its bits: sign, 5 of exponent, 10 of fraction. Rounding to it
/// has a relative error of at most 2^-11 (4.9e-4) from 2^-14 (6.1e-5) to 65504, and an absolute one
/// of at most 2^-25 (3.0e-8) below.
struct Half {
  std::uint16_t bits = 0;
};

/// The value, exactly.
[[nodiscard]] float to_float(Half half);

/// Rounds to nearest, ties to even; 65520 and above become infinity. Devices round the same way.
[[nodiscard]] Half to_half(float value);

}  // namespace pillarfield
