#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "base/wide.h"
#include "contacts/contact_sum.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// So many pillars of a row, side by side, are looked at together: loops of a fixed length over
/// plain arrays, of which compilers make vector instructions.
inline constexpr std::uint32_t kBlock = 16;

/// Vectors by name, since of loops that would do compilers make poor ones: eight floats or whole
/// numbers, four whole numbers or their doubles. Where a processor has shorter ones, each is
/// several.
using Floats [[gnu::vector_size(32)]] = float;
using Wholes [[gnu::vector_size(32)]] = std::int32_t;
using FourWholes [[gnu::vector_size(16)]] = std::int32_t;
using FourDoubles [[gnu::vector_size(32)]] = double;
inline constexpr std::uint32_t kLanes = 8;

/// Forces of smaller magnitude, N, are less than 2^28 quanta: the sum of six of them fits 31 bits.
inline constexpr float kMostBlockForceN = 16;

/// All bits set, kBlock times, then none as often.
template <class Number>
inline constexpr auto kMasks = [] {
  std::array<Number, 2 * std::size_t{kBlock}> masks{};
  for (std::size_t i = 0; i < kBlock; ++i) masks.at(i) = static_cast<Number>(~Number{0});
  return masks;
}();

/// A vector from any place in memory. Vectors go by reference: how they are returned depends on the
/// processor.
template <class Vector, class Value>
PF_INLINE void load(const Value* from, Vector& vector) {
  std::memcpy(&vector, from, sizeof(Vector));
}

/// Takes those lanes out of a mask whose force is kMostBlockForceN or more, or NaN.
PF_INLINE void keep_small(const Floats& force_n, Wholes& mask) {
  constexpr auto kMost = std::bit_cast<std::int32_t>(kMostBlockForceN);
  mask &= (__builtin_bit_cast(Wholes, force_n) & INT32_MAX) < kMost;
}

/// Rounds small forces as ForceQuanta does; those outside `mask` may be any and become zero.
PF_INLINE void quantise(const Floats& force_n, const Wholes& mask, Wholes& quanta) {
  constexpr float kQuantaPerNewton = 1 / static_cast<float>(ForceQuanta::kForceQuantum);
  // With the largest float below a half, sums with less than a half behind the point stay below the
  // next number, and those with a half are rounded up to it.
  constexpr auto kBelowHalf = std::bit_cast<std::int32_t>(0x1.fffffep-2F);
  const Wholes kept = __builtin_bit_cast(Wholes, force_n) & mask;
  const Floats scaled = __builtin_bit_cast(Floats, kept) * kQuantaPerNewton;  // exact
  const Wholes half = (__builtin_bit_cast(Wholes, scaled) & INT32_MIN) | kBelowHalf;
  quanta = __builtin_convertvector(scaled + __builtin_bit_cast(Floats, half), Wholes);
}

/// What leaves a force in doubt although enough sensels are usable.
inline constexpr int kDoubtful =
    status::kFromNeighbours | status::kSaturated | status::kInconsistent;

/// Whether a pillar is in region 1 or 2 and nothing is wrong with it.
PF_INLINE bool is_known(std::uint8_t bits) {
  return is_determined(bits) && (bits & kDoubtful) == 0;
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

/// Asks for what the next runs need of a plane, at the first one for all of them up to there: rows
/// are too far apart for a processor to guess.
template <class Value>
PF_INLINE void ask_for(std::span<const Value> plane, const ForceFieldView& forces,
                       std::span<const ContactRun> runs, std::size_t run) {
#if defined(__GNUC__)
  constexpr std::size_t kAhead = 4;
  constexpr std::uint32_t kLine = 64 / sizeof(Value);
  const std::size_t end = std::min(run + kAhead + 1, runs.size());
  for (std::size_t at = run == 0 ? 0 : run + kAhead; at < end; ++at) {
    const ContactRun& ahead = runs[at];
    const Value* const row = plane.data() + std::size_t{ahead.row} * forces.cols;
    for (std::uint32_t col = ahead.first; col < ahead.end + kLine; col += kLine) {
      __builtin_prefetch(row + std::min(col, ahead.end - 1));
    }
  }
#endif
}

}  // namespace pillarfield
