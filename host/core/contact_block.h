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

/// Negative where one of a block's forces is kMostBlockForceN or more, or NaN.
PF_INLINE std::int32_t room_of(const float* force_n) {
  // The bits of the largest magnitude that fits. NaN's are more.
  constexpr auto kMost = std::bit_cast<std::int32_t>(kMostBlockForceN) - 1;
  std::int32_t room = 0;
  for (std::size_t i = 0; i < kBlock; ++i) {
    room |= kMost - (std::bit_cast<std::int32_t>(force_n[i]) & 0x7fffffff);
  }
  return room;
}

/// Rounds a block's forces as ForceQuanta does, and sets those outside `mask` to zero.
PF_INLINE BlockQuanta quantised(const float* force_n, const std::int32_t* mask) {
  constexpr float kQuantaPerNewton = 1 / static_cast<float>(ForceQuanta::kForceQuantum);
  BlockQuanta quanta;  // of its own, for the loop to be free to read and write in any order
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float scaled = force_n[i] * kQuantaPerNewton;  // exact, as is what follows
    const auto whole = static_cast<std::int32_t>(scaled);
    const float rest = scaled - static_cast<float>(whole);
    const std::int32_t up = rest >= 0.5F ? 1 : 0;
    const std::int32_t down = rest <= -0.5F ? 1 : 0;
    quanta[i] = (whole + up - down) & mask[i];
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

/// Whether all blocks of a piece may be read as such: their forces fit, and what is read past the
/// end, and masked, is there.
PF_INLINE bool makes_blocks(const ForceFieldView& forces, std::size_t begin, std::size_t pillars) {
  const std::size_t end = begin + (pillars + kBlock - 1) / kBlock * kBlock;
  if (end > forces.normal.size()) return false;
  std::int32_t room = 0;
  for (std::size_t at = begin; at < end; at += kBlock) {
    room |= room_of(forces.shear_x.data() + at) | room_of(forces.shear_y.data() + at) |
            room_of(forces.normal.data() + at);
  }
  return room >= 0;
}

}  // namespace pillarfield
