#pragma once

#include <cstdint>

namespace pillarfield {

/// A number of IEEE half precision, as its bits: sign, 5 of exponent, 10 of fraction. From 2^-14
/// (6.1e-5) to 65504 its relative error is at most 2^-11 (4.9e-4); below, the absolute one is at
/// most 2^-25 (3.0e-8).
struct Half {
  std::uint16_t bits = 0;
};

/// Exact.
[[nodiscard]] float to_float(Half half);

/// The nearest one, of two the even one; from 65520 on infinity. The device rounds alike, bit for
/// bit.
[[nodiscard]] Half to_half(float value);

}  // namespace pillarfield
