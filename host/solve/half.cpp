#include "pillarfield/half.h"

#include <bit>

#include "solve/pillar_maths.h"

namespace pillarfield {

float to_float(Half half) {
  constexpr std::uint32_t kSign = 0x8000;
  constexpr std::uint32_t kInfinity = 0x7c00;
  const std::uint32_t size = half.bits & (kSign - 1);
  // The fraction in its place, with an exponent that counts from 112 too low.
  const float scaled = std::bit_cast<float>(size << 13) * 0x1p112F;
  const std::uint32_t bits =
      size < kInfinity ? std::bit_cast<std::uint32_t>(scaled) : size << 13 | 0x7f800000;
  return std::bit_cast<float>(bits | (half.bits & kSign) << 16);
}

Half to_half(float value) {
  return {static_cast<std::uint16_t>(single_precision::bits_of_half(value))};
}

}  // namespace pillarfield
