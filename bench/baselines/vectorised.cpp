#include "bench/baselines/vectorised.h"

// Highway compiles this file once for each target; AVX3_DL does not speed up this solve.
#define HWY_DISABLED_TARGETS HWY_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/baselines/vectorised.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h must precede highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/baselines/bare_solve.h"
#include "pillarfield/error.h"

HWY_BEFORE_NAMESPACE();
namespace pillarfield::bench::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void solve_cached(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                  std::uint32_t last, const ForcePlanes& to) {
  solve_rows_plainly(solve, frame, first, last, to);
}

void solve_streaming(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                     std::uint32_t last, const ForcePlanes& to) {
  solve_rows_plainly(solve, frame, first, last, to);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Counts = hn::ScalableTag<std::int16_t>;
using Vector = hn::Vec<Counts>;
using Mask = hn::Mask<Counts>;
constexpr Counts kCounts;
constexpr std::size_t kLanes = hn::MaxLanes(kCounts);
constexpr std::size_t kBlock = 2 * kLanes;  ///< pillars: whole or half cache lines of each plane

/// Constants of the solve in integers; forces are in eighths of a count.
struct EighthCounts {
  std::int16_t threshold;  ///< counts
  std::int16_t margin;     ///< counts: floor of the solve's -margin
  float shear_scale;       ///< N per eighth of a count
  float normal_scale;      ///< N per eighth of a count
};

/// A row of pillars, or the rest of one.
struct Row {
  const std::uint8_t* top;
  const std::uint8_t* bottom;
  ForcePlanes to;
};

HWY_INLINE Row from(const Row& row, std::size_t col) {
  return {row.top + 2 * col, row.bottom + 2 * col, advanced(row.to, col)};
}

/// V_p - V_q of a diagonal of parity sum `sum`, both in eighths of a count.
HWY_INLINE Vector difference(Vector p, Vector q, Mask p_usable, Mask q_usable, Vector sum) {
  const Vector by_p = hn::Sub(hn::ShiftLeft<4>(p), sum);
  const Vector by_q = hn::Sub(sum, hn::ShiftLeft<4>(q));
  const Vector both = hn::ShiftLeft<3>(hn::Sub(p, q));
  const Vector with_p = hn::IfThenElse(q_usable, both, by_p);
  return hn::IfThenElse(p_usable, with_p, hn::IfThenElseZero(q_usable, by_q));
}

/// Whether parity sum `sum` of a full diagonal predicts more than -margin for the inactive one of
/// p, q.
HWY_INLINE Mask may_press(Mask one_usable, Vector p, Vector q, Vector sum, Vector margin) {
  // The usable one of the two is the larger: the other was raised to the threshold.
  return hn::And(one_usable, hn::Gt(hn::Sub(sum, hn::Max(p, q)), margin));
}

HWY_INLINE Vector bit_where(Mask mask, std::int16_t bit) {
  return hn::IfThenElseZero(mask, hn::Set(kCounts, bit));
}

/// Stores a vector of forces.
template <bool streaming>
HWY_INLINE void store_forces(Vector eighths, float newtons, float* plane) {
  constexpr hn::RepartitionToWide<Counts> kWide;
  constexpr hn::Rebind<float, decltype(kWide)> kFloats;
  constexpr hn::Half<Counts> kHalf;
  const auto scale = hn::Set(kFloats, newtons);
  const auto low = hn::PromoteTo(kWide, hn::LowerHalf(eighths));
  const auto high = hn::PromoteTo(kWide, hn::UpperHalf(kHalf, eighths));
  const auto low_n = hn::Mul(hn::ConvertTo(kFloats, low), scale);
  const auto high_n = hn::Mul(hn::ConvertTo(kFloats, high), scale);
  if constexpr (streaming) {
    hn::Stream(low_n, kFloats, plane);
    hn::Stream(high_n, kFloats, plane + kLanes / 2);
  } else {
    hn::StoreU(low_n, kFloats, plane);
    hn::StoreU(high_n, kFloats, plane + kLanes / 2);
  }
}

/// Solves a vector of pillars, stores their forces and returns their status.
template <bool streaming>
HWY_INLINE Vector solve_vector(const Row& row, const EighthCounts& solve) {
  constexpr hn::Repartition<std::uint8_t, Counts> kBytes;
  constexpr hn::RebindToUnsigned<Counts> kUnsigned;
  const auto top = hn::BitCast(kUnsigned, hn::LoadU(kBytes, row.top));
  const auto bottom = hn::BitCast(kUnsigned, hn::LoadU(kBytes, row.bottom));
  const auto low_byte = hn::Set(kUnsigned, 0xff);
  const Vector threshold = hn::Set(kCounts, solve.threshold);
  const Vector margin = hn::Set(kCounts, solve.margin);
  const Vector r1 = hn::BitCast(kCounts, hn::ShiftRight<8>(top));
  const Vector r2 = hn::BitCast(kCounts, hn::And(top, low_byte));
  const Vector r3 = hn::BitCast(kCounts, hn::And(bottom, low_byte));
  const Vector r4 = hn::BitCast(kCounts, hn::ShiftRight<8>(bottom));
  const Mask u1 = hn::Gt(r1, threshold);
  const Mask u2 = hn::Gt(r2, threshold);
  const Mask u3 = hn::Gt(r3, threshold);
  const Mask u4 = hn::Gt(r4, threshold);
  const Vector v1 = hn::Max(r1, threshold);
  const Vector v2 = hn::Max(r2, threshold);
  const Vector v3 = hn::Max(r3, threshold);
  const Vector v4 = hn::Max(r4, threshold);

  const Vector rising = hn::Add(v1, v3);
  const Vector falling = hn::Add(v2, v4);
  const Mask rising_full = hn::And(u1, u3);
  const Mask falling_full = hn::And(u2, u4);
  const Mask rising_any = hn::Or(u1, u3);
  const Mask falling_any = hn::Or(u2, u4);
  // An undetermined sum is 7/8 of its bound on a segment, else half of it.
  const Vector bound =
      hn::IfThenElseZero(hn::Or(rising_any, falling_any), hn::Min(rising, falling));
  const Mask on_segment = hn::And(rising_any, falling_any);
  Vector sum =
      hn::IfThenElse(on_segment, hn::Sub(hn::ShiftLeft<3>(bound), bound), hn::ShiftLeft<2>(bound));
  sum = hn::IfThenElse(rising_full, hn::ShiftLeft<3>(rising), sum);
  sum = hn::IfThenElse(falling_full, hn::ShiftLeft<3>(falling), sum);
  sum = hn::IfThenElse(hn::And(rising_full, falling_full),
                       hn::ShiftLeft<2>(hn::Add(rising, falling)), sum);
  const Vector along_rising = difference(v1, v3, u1, u3, sum);
  const Vector along_falling = difference(v2, v4, u2, u4, sum);
  store_forces<streaming>(hn::Sub(along_rising, along_falling), solve.shear_scale, row.to.shear_x);
  store_forces<streaming>(hn::Add(along_rising, along_falling), solve.shear_scale, row.to.shear_y);
  store_forces<streaming>(sum, solve.normal_scale, row.to.normal);

  const Mask segment =
      hn::AndNot(hn::Or(rising_full, falling_full), hn::Gt(bound, hn::Zero(kCounts)));
  const Mask can_hide = hn::Gt(threshold, hn::Zero(kCounts));
  const Mask hidden = hn::And(
      can_hide, hn::Or(may_press(hn::And(falling_full, hn::Xor(u1, u3)), v1, v3, falling, margin),
                       may_press(hn::And(rising_full, hn::Xor(u2, u4)), v2, v4, rising, margin)));
  const Mask opposite =
      hn::Or(hn::AndNot(falling_any, rising_full), hn::AndNot(rising_any, falling_full));
  const Vector usable = hn::Or(hn::Or(bit_where(u1, 1), bit_where(u2, 2)),
                               hn::Or(bit_where(u3, 4), bit_where(u4, 8)));
  return hn::Or(usable, hn::Or(bit_where(hn::Or(segment, hidden), 16), bit_where(opposite, 64)));
}

template <bool streaming>
HWY_INLINE void solve_block(const Row& row, const EighthCounts& solve) {
  constexpr hn::Rebind<std::uint8_t, Counts> kHalf;
  constexpr hn::Repartition<std::uint8_t, Counts> kBytes;
  const Vector low = solve_vector<streaming>(row, solve);
  const Vector high = solve_vector<streaming>(from(row, kLanes), solve);
  const auto status = hn::Combine(kBytes, hn::DemoteTo(kHalf, high), hn::DemoteTo(kHalf, low));
  if constexpr (streaming) {
    hn::Stream(status, kBytes, row.to.status);
  } else {
    hn::StoreU(status, kBytes, row.to.status);
  }
}

HWY_INLINE void solve_half_block(const Row& row, const EighthCounts& solve) {
  constexpr hn::Rebind<std::uint8_t, Counts> kHalf;
  hn::StoreU(hn::DemoteTo(kHalf, solve_vector<false>(row, solve)), kHalf, row.to.status);
}

/// Solves `count` pillars, fewer than a vector holds, through buffers of a whole vector.
HWY_INLINE void solve_some(const Row& row, std::size_t count, const EighthCounts& solve) {
  std::array<std::uint8_t, 2 * kLanes> top{};
  std::array<std::uint8_t, 2 * kLanes> bottom{};
  std::array<std::array<float, kLanes>, 3> forces{};
  std::array<std::uint8_t, kLanes> status{};
  std::copy_n(row.top, 2 * count, top.data());
  std::copy_n(row.bottom, 2 * count, bottom.data());
  const ForcePlanes planes = {forces[0].data(), forces[1].data(), forces[2].data(), status.data()};
  solve_half_block({top.data(), bottom.data(), planes}, solve);
  std::copy_n(planes.shear_x, count, row.to.shear_x);
  std::copy_n(planes.shear_y, count, row.to.shear_y);
  std::copy_n(planes.normal, count, row.to.normal);
  std::copy_n(planes.status, count, row.to.status);
}

/// Solves the pillars [col, end) at any alignment. It may write neighbours twice, except with
/// nontemporal stores.
template <bool streaming>
HWY_INLINE void solve_end(const Row& row, std::size_t col, std::size_t end, std::size_t cols,
                          const EighthCounts& solve) {
  for (; col < end; col += kLanes) {
    if (streaming && end - col < kLanes) return solve_some(from(row, col), end - col, solve);
    solve_half_block(from(row, std::min(col, cols - kLanes)), solve);
  }
}

/// Prefetches reads 4096 bytes ahead, since the hardware prefetcher stops at the ends of rows. The
/// distance was found by experiment; prefetching stores gained nothing.
HWY_INLINE void prefetch(const Row& row) {
  for (std::size_t i = 4096; i < 4096 + 2 * kBlock; i += 64) {
    hwy::Prefetch(row.top + i);
    hwy::Prefetch(row.bottom + i);
  }
}

/// Solves a row whose first whole cache line begins after `head` pillars.
template <bool streaming>
HWY_INLINE void solve_row(const Row& row, std::size_t head, std::size_t cols,
                          const EighthCounts& solve) {
  if (cols < kLanes) return solve_some(row, cols, solve);
  std::size_t col = std::min(head, cols);
  solve_end<streaming>(row, 0, col, cols, solve);
  for (; col + kBlock <= cols; col += kBlock) {
    const Row rest = from(row, col);
    prefetch(rest);
    solve_block<streaming>(rest, solve);
  }
  solve_end<streaming>(row, col, cols, cols, solve);
}

template <bool streaming>
void solve_rows(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                std::uint32_t last, const ForcePlanes& to) {
  const EighthCounts constants = {
      static_cast<std::int16_t>(solve.threshold),
      static_cast<std::int16_t>(std::floor(std::max(-solve.margin, -2000.0F))),
      solve.shear_scale / 8, solve.normal_scale / 8};
  const auto* const readings = static_cast<const std::uint8_t*>(frame.data);
  const std::size_t cols = frame.cols / 2;
  for (std::size_t row = first; row < last; ++row) {
    const std::uint8_t* const top = readings + 2 * row * frame.row_stride;
    const std::size_t index = row * cols;
    const Row whole = {top, top + frame.row_stride, advanced(to, index)};
    solve_row<streaming>(whole, -index % kBlock, cols, constants);
  }
  if (streaming) hwy::FlushStream();
}

void solve_cached(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                  std::uint32_t last, const ForcePlanes& to) {
  solve_rows<false>(solve, frame, first, last, to);
}

void solve_streaming(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                     std::uint32_t last, const ForcePlanes& to) {
  solve_rows<true>(solve, frame, first, last, to);
}

#endif

const char* instructions() { return hwy::TargetName(HWY_TARGET); }

}  // namespace pillarfield::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pillarfield::bench {

HWY_EXPORT(solve_cached);
HWY_EXPORT(solve_streaming);
HWY_EXPORT(instructions);

std::vector<Vectorised> vectorised() {
  std::vector<Vectorised> all;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::GetChosenTarget().Update(target);
    all.push_back({HWY_DYNAMIC_DISPATCH(instructions)(), HWY_DYNAMIC_DISPATCH(solve_cached),
                   HWY_DYNAMIC_DISPATCH(solve_streaming)});
  }
  return all;
}

void require_whole_threshold(const BareSolve& solve) {
  if (solve.threshold <= 255 && solve.threshold == std::floor(solve.threshold)) return;
  throw Error("baseline", "the threshold is not a whole number of counts up to 255",
              "use a whole threshold");
}

}  // namespace pillarfield::bench
#endif
