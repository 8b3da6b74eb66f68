#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/contact_sum.h"
#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

// A function that is also compiled for wider vectors, the program choosing as it starts; and one
// that such a function takes in whole.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define PF_WIDE [[gnu::target_clones("default", "avx2")]]
#define PF_INLINE [[gnu::always_inline]] inline
#else
#define PF_WIDE
#define PF_INLINE inline
#endif

namespace pillarfield {

/// So many pillars of a row, side by side, are looked at together: loops of a fixed length over
/// plain arrays, of which compilers make vector instructions.
inline constexpr std::uint32_t kBlock = 16;

using BlockQuanta = std::array<std::int32_t, kBlock>;

/// Forces below this, N, are at most 2^30 quanta.
inline constexpr float kMostBlockForceN = 64;

/// All bits set, kBlock times, then none as often.
template <class Number>
inline constexpr auto kMasks = [] {
  std::array<Number, 2 * std::size_t{kBlock}> masks{};
  for (std::size_t i = 0; i < kBlock; ++i) masks.at(i) = static_cast<Number>(~Number{0});
  return masks;
}();

/// Bits of a force's magnitude, which are in the order of magnitudes.
PF_INLINE std::int32_t magnitude_bits(float force_n) {
  return std::bit_cast<std::int32_t>(force_n) & 0x7fffffff;
}

/// Rounds a block's forces as ForceQuanta does, and sets those outside `mask` to zero.
PF_INLINE BlockQuanta quantised(const float* force_n, const std::int32_t* mask) {
  constexpr float kQuantaPerNewton = 1 / static_cast<float>(ForceQuanta::kForceQuantum);
  // With the largest float below a half, sums with less than a half behind the point stay below the
  // next number, and those with a half are rounded up to it.
  constexpr float kBelowHalf = 0x1.fffffep-2F;
  BlockQuanta quanta;  // of its own, for the loop to be free to read and write in any order
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float scaled = force_n[i] * kQuantaPerNewton;  // exact
    quanta[i] = static_cast<std::int32_t>(scaled + std::copysign(kBelowHalf, scaled)) & mask[i];
  }
  return quanta;
}

/// Whether a pillar is in region 1 or 2 and nothing is wrong with it.
PF_INLINE bool is_known(std::uint8_t bits) {
  constexpr int kDoubtful = status::kFromNeighbours | status::kSaturated | status::kInconsistent;
  const int lifted = ~bits & status::kUsable;
  return ((lifted & (lifted - 1)) | (bits & kDoubtful)) == 0;
}

/// Places as in PillarForce.
inline std::int64_t place_x(const ForceFieldView& forces, std::uint32_t col) {
  return 2 * std::int64_t{col} + 1 - forces.cols;
}

inline std::int64_t place_y(const ForceFieldView& forces, std::uint32_t row) {
  return forces.rows - 2 * std::int64_t{row} - 1;
}

/// A pillar by itself, whatever its forces are.
inline PillarForce pillar_at(const ForceFieldView& forces, const ForceQuanta& quanta,
                             std::uint32_t row, std::uint32_t col) {
  const std::size_t place = std::size_t{row} * forces.cols + col;
  return {quanta.of(forces.shear_x[place]),
          quanta.of(forces.shear_y[place]),
          quanta.of(forces.normal[place]),
          place_x(forces, col),
          place_y(forces, row),
          forces.status[place]};
}

/// Whether the block at `begin` may be read as such: its forces fit, and what is read past the end
/// of a run, and masked, is there.
PF_INLINE bool makes_block(const ForceFieldView& forces, std::size_t begin) {
  if (begin + kBlock > forces.normal.size()) return false;
  const float* const shear_x = forces.shear_x.data() + begin;
  const float* const shear_y = forces.shear_y.data() + begin;
  const float* const normal = forces.normal.data() + begin;
  std::int32_t largest = 0;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::int32_t shear = std::max(magnitude_bits(shear_x[i]), magnitude_bits(shear_y[i]));
    largest = std::max(largest, std::max(shear, magnitude_bits(normal[i])));
  }
  // NaN's bits are more.
  return largest < std::bit_cast<std::int32_t>(kMostBlockForceN);
}

}  // namespace pillarfield
