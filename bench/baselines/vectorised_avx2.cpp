#include "bench/baselines/vectorised_avx2.h"

#ifdef __x86_64__
#include <immintrin.h>

#include <array>
#include <cstring>

#include "bench/baselines/ask_ahead.h"
#include "bench/baselines/eighth_counts.h"

#define PF_AVX2 __attribute__((target("avx2"))) inline

namespace pillarfield::bench {
namespace {

/// Forces in eighths of a count and status bytes, all as int16, of 16 pillars.
struct Solved {
  __m256i shear_x;
  __m256i shear_y;
  __m256i normal;
  __m256i status;
};

PF_AVX2 __m256i choose(__m256i mask, __m256i yes, __m256i no) {
  return _mm256_blendv_epi8(no, yes, mask);
}

/// A status bit where the mask is set.
PF_AVX2 __m256i bit_where(__m256i mask, short bit) {
  return _mm256_and_si256(mask, _mm256_set1_epi16(bit));
}

/// V_p - V_q of a diagonal of parity sum `sum`, both in eighths of a count.
PF_AVX2 __m256i difference(__m256i p, __m256i q, __m256i p_usable, __m256i q_usable, __m256i sum) {
  const __m256i by_p = _mm256_sub_epi16(_mm256_slli_epi16(p, 4), sum);
  const __m256i by_q = _mm256_sub_epi16(sum, _mm256_slli_epi16(q, 4));
  const __m256i both = _mm256_slli_epi16(_mm256_sub_epi16(p, q), 3);
  const __m256i without_p = _mm256_and_si256(q_usable, by_q);
  const __m256i with_p = choose(q_usable, both, by_p);
  return choose(p_usable, with_p, without_p);
}

/// Whether a full diagonal of parity sum `sum` leaves more than -doubt for the silent one of p, q.
PF_AVX2 __m256i may_press(__m256i one_usable, __m256i p, __m256i q, __m256i sum,
                          const EighthCounts& solve) {
  // The usable one of the two is the larger: it is above the threshold, at which the other stands.
  const __m256i left = _mm256_sub_epi16(sum, _mm256_max_epi16(p, q));
  return _mm256_and_si256(one_usable, _mm256_cmpgt_epi16(left, _mm256_set1_epi16(solve.doubt)));
}

/// `top` and `bottom` are 32 readings each.
PF_AVX2 Solved solve_16(__m256i top, __m256i bottom, const EighthCounts& solve) {
  const __m256i low_bytes = _mm256_set1_epi16(0xFF);
  const __m256i threshold = _mm256_set1_epi16(solve.threshold);
  const __m256i r1 = _mm256_srli_epi16(top, 8);
  const __m256i r2 = _mm256_and_si256(top, low_bytes);
  const __m256i r3 = _mm256_and_si256(bottom, low_bytes);
  const __m256i r4 = _mm256_srli_epi16(bottom, 8);
  const __m256i u1 = _mm256_cmpgt_epi16(r1, threshold);
  const __m256i u2 = _mm256_cmpgt_epi16(r2, threshold);
  const __m256i u3 = _mm256_cmpgt_epi16(r3, threshold);
  const __m256i u4 = _mm256_cmpgt_epi16(r4, threshold);
  const __m256i v1 = _mm256_max_epi16(r1, threshold);
  const __m256i v2 = _mm256_max_epi16(r2, threshold);
  const __m256i v3 = _mm256_max_epi16(r3, threshold);
  const __m256i v4 = _mm256_max_epi16(r4, threshold);

  const __m256i rising = _mm256_add_epi16(v1, v3);
  const __m256i falling = _mm256_add_epi16(v2, v4);
  const __m256i rising_full = _mm256_and_si256(u1, u3);
  const __m256i falling_full = _mm256_and_si256(u2, u4);
  const __m256i rising_any = _mm256_or_si256(u1, u3);
  const __m256i falling_any = _mm256_or_si256(u2, u4);
  const __m256i any = _mm256_or_si256(rising_any, falling_any);
  // An undetermined sum is 7/8 of its bound on a segment, else half of it.
  const __m256i bound = _mm256_and_si256(any, _mm256_min_epi16(rising, falling));
  const __m256i on_segment = _mm256_and_si256(rising_any, falling_any);
  const __m256i point = choose(on_segment, _mm256_sub_epi16(_mm256_slli_epi16(bound, 3), bound),
                               _mm256_slli_epi16(bound, 2));
  // What a full diagonal says, or the bound; the other diagonal's word where only that is full.
  const __m256i by_rising = choose(rising_full, rising, falling);
  const __m256i by_falling = choose(falling_full, falling, rising);
  const __m256i determined = _mm256_or_si256(rising_full, falling_full);
  const __m256i both = _mm256_slli_epi16(_mm256_add_epi16(by_rising, by_falling), 2);
  const __m256i sum = choose(determined, both, point);

  const __m256i along_rising = difference(v1, v3, u1, u3, sum);
  const __m256i along_falling = difference(v2, v4, u2, u4, sum);

  const __m256i segment =
      _mm256_andnot_si256(determined, _mm256_cmpgt_epi16(bound, _mm256_setzero_si256()));
  const __m256i can_hide = _mm256_set1_epi16(solve.threshold > 0 ? -1 : 0);
  const __m256i falling_alone = _mm256_and_si256(can_hide, falling_full);
  const __m256i rising_alone = _mm256_and_si256(can_hide, rising_full);
  const __m256i hidden = _mm256_or_si256(
      may_press(_mm256_and_si256(falling_alone, _mm256_xor_si256(u1, u3)), v1, v3, falling, solve),
      may_press(_mm256_and_si256(rising_alone, _mm256_xor_si256(u2, u4)), v2, v4, rising, solve));
  const __m256i opposite = _mm256_or_si256(_mm256_andnot_si256(falling_any, rising_full),
                                           _mm256_andnot_si256(rising_any, falling_full));

  Solved solved{};
  solved.shear_x = _mm256_sub_epi16(along_rising, along_falling);
  solved.shear_y = _mm256_add_epi16(along_rising, along_falling);
  solved.normal = sum;
  const __m256i usable = _mm256_or_si256(_mm256_or_si256(bit_where(u1, 1), bit_where(u2, 2)),
                                         _mm256_or_si256(bit_where(u3, 4), bit_where(u4, 8)));
  const __m256i ambiguous = bit_where(_mm256_or_si256(segment, hidden), 16);
  solved.status = _mm256_or_si256(usable, _mm256_or_si256(ambiguous, bit_where(opposite, 64)));
  return solved;
}

/// 8 of 16 forces.
PF_AVX2 __m256 newtons(__m128i eighths, float scale) {
  const __m256i wide = _mm256_cvtepi16_epi32(eighths);
  return _mm256_mul_ps(_mm256_cvtepi32_ps(wide), _mm256_set1_ps(scale));
}

/// 16 forces of a plane.
template <bool streaming>
PF_AVX2 void store_plane(float* plane, __m256i eighths, float scale) {
  const __m256 low = newtons(_mm256_castsi256_si128(eighths), scale);
  const __m256 high = newtons(_mm256_extracti128_si256(eighths, 1), scale);
  if (streaming) {
    _mm256_stream_ps(plane, low);
    _mm256_stream_ps(plane + 8, high);
  } else {
    _mm256_storeu_ps(plane, low);
    _mm256_storeu_ps(plane + 8, high);
  }
}

template <bool streaming>
PF_AVX2 void store_forces(const ForcePlanes& to, const Solved& solved, const EighthCounts& solve) {
  store_plane<streaming>(to.shear_x, solved.shear_x, solve.shear_scale);
  store_plane<streaming>(to.shear_y, solved.shear_y, solve.shear_scale);
  store_plane<streaming>(to.normal, solved.normal, solve.normal_scale);
}

PF_AVX2 __m256i load(const std::uint8_t* readings) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(readings));
}

/// 32 pillars.
template <bool streaming>
PF_AVX2 void solve_32(const std::uint8_t* top, const std::uint8_t* bottom,
                      const EighthCounts& solve, const ForcePlanes& to) {
  const Solved low = solve_16(load(top), load(bottom), solve);
  store_forces<streaming>(to, low, solve);
  const Solved high = solve_16(load(top + 32), load(bottom + 32), solve);
  store_forces<streaming>(advanced(to, 16), high, solve);
  // Packing works within halves of a register, and leaves quarters in the order 0 2 1 3.
  const __m256i packed = _mm256_packus_epi16(low.status, high.status);
  const __m256i status = _mm256_permute4x64_epi64(packed, 0b11'01'10'00);
  auto* const bytes = reinterpret_cast<__m256i*>(to.status);
  if (streaming) {
    _mm256_stream_si256(bytes, status);
  } else {
    _mm256_storeu_si256(bytes, status);
  }
}

/// A row of pillars.
struct Row {
  const std::uint8_t* top;
  const std::uint8_t* bottom;
  ForcePlanes to;
};

/// `count` pillars, at most 32, by way of memory in which there is room for all.
PF_AVX2 void solve_some(const Row& row, std::size_t count, const EighthCounts& solve) {
  std::array<std::uint8_t, 64> top{};
  std::array<std::uint8_t, 64> bottom{};
  std::array<std::array<float, 32>, 3> forces{};
  std::array<std::uint8_t, 32> status{};
  std::memcpy(top.data(), row.top, 2 * count);
  std::memcpy(bottom.data(), row.bottom, 2 * count);
  solve_32<false>(top.data(), bottom.data(), solve,
                  {forces[0].data(), forces[1].data(), forces[2].data(), status.data()});
  std::memcpy(row.to.shear_x, forces[0].data(), count * sizeof(float));
  std::memcpy(row.to.shear_y, forces[1].data(), count * sizeof(float));
  std::memcpy(row.to.normal, forces[2].data(), count * sizeof(float));
  std::memcpy(row.to.status, status.data(), count);
}

/// What is left of a row from pillar `col` on.
PF_AVX2 Row from(const Row& row, std::size_t col) {
  return {row.top + 2 * col, row.bottom + 2 * col, advanced(row.to, col)};
}

/// `head` pillars lie before the first whole half line of the row.
template <bool streaming>
PF_AVX2 void solve_row(const Row& row, std::uint32_t head, std::uint32_t cols,
                       const EighthCounts& solve) {
  std::uint32_t col = head < cols ? head : cols;
  solve_some(row, col, solve);
  for (; col + 32 <= cols; col += 32) {
    const Row rest = from(row, col);
    ask_ahead<32>(rest.top, rest.bottom);
    solve_32<streaming>(rest.top, rest.bottom, solve, rest.to);
  }
  solve_some(from(row, col), cols - col, solve);
}

template <bool streaming>
__attribute__((target("avx2"))) void solve_rows(const BareSolve& solve, const FrameView& frame,
                                                std::uint32_t first, std::uint32_t last,
                                                const ForcePlanes& to) {
  const EighthCounts constants(solve);
  const auto* const readings = static_cast<const std::uint8_t*>(frame.data);
  const std::uint32_t cols = frame.cols / 2;
  for (std::size_t row = first; row < last; ++row) {
    const std::uint8_t* const top = readings + 2 * row * frame.row_stride;
    const std::size_t index = row * cols;
    // Halves of cache lines begin in all planes where the index is a multiple of 32.
    const auto head = static_cast<std::uint32_t>(-index % 32);
    solve_row<streaming>({top, top + frame.row_stride, advanced(to, index)}, head, cols, constants);
  }
  if (streaming) _mm_sfence();
}

}  // namespace

void solve_rows_avx2_cached(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                            std::uint32_t last, const ForcePlanes& to) {
  solve_rows<false>(solve, frame, first, last, to);
}

void solve_rows_avx2_streaming(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                               std::uint32_t last, const ForcePlanes& to) {
  solve_rows<true>(solve, frame, first, last, to);
}

}  // namespace pillarfield::bench
#endif
