#include "bench/baselines/vectorised_avx512.h"

#ifdef __x86_64__
#include <immintrin.h>

#include "bench/baselines/ask_ahead.h"
#include "bench/baselines/eighth_counts.h"

#define PF_AVX512 __attribute__((target("avx512f,avx512bw,avx512vl"))) inline

namespace pillarfield::bench {
namespace {

/// Forces in eighths of a count and status bytes of 32 pillars.
struct Solved {
  __m512i shear_x;  ///< int16
  __m512i shear_y;
  __m512i normal;
  __m256i status;
};

/// One of the status bits in the bytes that a mask names.
PF_AVX512 __m256i bit_where(__mmask32 where, char bit) {
  return _mm256_maskz_set1_epi8(where, bit);
}

/// V_p - V_q of a diagonal of parity sum `sum`, both in eighths of a count.
PF_AVX512 __m512i difference(__m512i p, __m512i q, __mmask32 p_usable, __mmask32 q_usable,
                             __m512i sum) {
  const __m512i by_p = _mm512_sub_epi16(_mm512_slli_epi16(p, 4), sum);
  const __m512i by_q = _mm512_sub_epi16(sum, _mm512_slli_epi16(q, 4));
  const __m512i both = _mm512_slli_epi16(_mm512_sub_epi16(p, q), 3);
  const __m512i by_one =
      _mm512_mask_mov_epi16(_mm512_maskz_mov_epi16(p_usable, by_p), ~p_usable & q_usable, by_q);
  return _mm512_mask_mov_epi16(by_one, p_usable & q_usable, both);
}

/// Whether a full diagonal of parity sum `sum` leaves more than -doubt for the silent one of p, q.
PF_AVX512 __mmask32 may_press(__mmask32 one_usable, __m512i p, __m512i q, __m512i sum,
                              const EighthCounts& solve) {
  // The usable one of the two is the larger: it is above the threshold, at which the other stands.
  const __m512i left = _mm512_sub_epi16(sum, _mm512_max_epi16(p, q));
  return _mm512_mask_cmpgt_epi16_mask(one_usable, left, _mm512_set1_epi16(solve.doubt));
}

/// `top` and `bottom` are 64 readings each.
PF_AVX512 Solved solve_32(__m512i top, __m512i bottom, const EighthCounts& solve) {
  const __m512i low_bytes = _mm512_set1_epi16(0xFF);
  const __m512i threshold = _mm512_set1_epi16(solve.threshold);
  const __m512i r1 = _mm512_srli_epi16(top, 8);
  const __m512i r2 = _mm512_and_si512(top, low_bytes);
  const __m512i r3 = _mm512_and_si512(bottom, low_bytes);
  const __m512i r4 = _mm512_srli_epi16(bottom, 8);
  const __mmask32 u1 = _mm512_cmpgt_epi16_mask(r1, threshold);
  const __mmask32 u2 = _mm512_cmpgt_epi16_mask(r2, threshold);
  const __mmask32 u3 = _mm512_cmpgt_epi16_mask(r3, threshold);
  const __mmask32 u4 = _mm512_cmpgt_epi16_mask(r4, threshold);
  const __m512i v1 = _mm512_max_epi16(r1, threshold);
  const __m512i v2 = _mm512_max_epi16(r2, threshold);
  const __m512i v3 = _mm512_max_epi16(r3, threshold);
  const __m512i v4 = _mm512_max_epi16(r4, threshold);

  const __m512i rising = _mm512_add_epi16(v1, v3);
  const __m512i falling = _mm512_add_epi16(v2, v4);
  const __mmask32 rising_full = u1 & u3;
  const __mmask32 falling_full = u2 & u4;
  const __mmask32 any = u1 | u2 | u3 | u4;
  // An undetermined sum is 7/8 of its bound on a segment, else half of it.
  const __m512i bound = _mm512_maskz_min_epi16(any, rising, falling);
  const __mmask32 on_segment = (u1 | u3) & (u2 | u4);
  __m512i sum = _mm512_slli_epi16(bound, 2);
  sum = _mm512_mask_sub_epi16(sum, on_segment, _mm512_slli_epi16(bound, 3), bound);
  sum = _mm512_mask_slli_epi16(sum, rising_full, rising, 3);
  sum = _mm512_mask_slli_epi16(sum, falling_full, falling, 3);
  const __m512i mean = _mm512_slli_epi16(_mm512_add_epi16(rising, falling), 2);
  sum = _mm512_mask_mov_epi16(sum, rising_full & falling_full, mean);

  const __m512i along_rising = difference(v1, v3, u1, u3, sum);
  const __m512i along_falling = difference(v2, v4, u2, u4, sum);

  const __mmask32 segment =
      _mm512_mask_cmpgt_epi16_mask(~(rising_full | falling_full), bound, _mm512_setzero_si512());
  const __mmask32 can_hide = solve.threshold > 0 ? ~__mmask32{0} : 0;
  const __mmask32 hidden = may_press(can_hide & falling_full & (u1 ^ u3), v1, v3, falling, solve) |
                           may_press(can_hide & rising_full & (u2 ^ u4), v2, v4, rising, solve);
  const __mmask32 opposite = (rising_full & ~(u2 | u4)) | (falling_full & ~(u1 | u3));

  Solved solved{};
  solved.shear_x = _mm512_sub_epi16(along_rising, along_falling);
  solved.shear_y = _mm512_add_epi16(along_rising, along_falling);
  solved.normal = sum;
  const __m256i usable = _mm256_or_si256(_mm256_or_si256(bit_where(u1, 1), bit_where(u2, 2)),
                                         _mm256_or_si256(bit_where(u3, 4), bit_where(u4, 8)));
  solved.status = _mm256_or_si256(
      usable, _mm256_or_si256(bit_where(segment | hidden, 16), bit_where(opposite, 64)));
  return solved;
}

PF_AVX512 __m512 newtons_low(__m512i eighths, __m512 scale) {
  const __m512i wide = _mm512_cvtepi16_epi32(_mm512_castsi512_si256(eighths));
  return _mm512_mul_ps(_mm512_cvtepi32_ps(wide), scale);
}

PF_AVX512 __m512 newtons_high(__m512i eighths, __m512 scale) {
  const __m512i wide = _mm512_cvtepi16_epi32(_mm512_extracti64x4_epi64(eighths, 1));
  return _mm512_mul_ps(_mm512_cvtepi32_ps(wide), scale);
}

/// 32 forces of a plane.
template <bool streaming>
PF_AVX512 void store_all(float* plane, __m512i eighths, float newtons) {
  const __m512 scale = _mm512_set1_ps(newtons);
  if (streaming) {
    _mm512_stream_ps(plane, newtons_low(eighths, scale));
    _mm512_stream_ps(plane + 16, newtons_high(eighths, scale));
  } else {
    _mm512_storeu_ps(plane, newtons_low(eighths, scale));
    _mm512_storeu_ps(plane + 16, newtons_high(eighths, scale));
  }
}

/// Those of them that `which` names.
PF_AVX512 void store_some(float* plane, __m512i eighths, float newtons, __mmask32 which) {
  const __m512 scale = _mm512_set1_ps(newtons);
  _mm512_mask_storeu_ps(plane, static_cast<__mmask16>(which), newtons_low(eighths, scale));
  _mm512_mask_storeu_ps(plane + 16, static_cast<__mmask16>(which >> 16),
                        newtons_high(eighths, scale));
}

/// 64 pillars: whole cache lines of every plane where `to` is at the beginning of one.
template <bool streaming>
PF_AVX512 void solve_64(const std::uint8_t* top, const std::uint8_t* bottom,
                        const EighthCounts& solve, const ForcePlanes& to) {
  const Solved low = solve_32(_mm512_loadu_si512(top), _mm512_loadu_si512(bottom), solve);
  store_all<streaming>(to.shear_x, low.shear_x, solve.shear_scale);
  store_all<streaming>(to.shear_y, low.shear_y, solve.shear_scale);
  store_all<streaming>(to.normal, low.normal, solve.normal_scale);
  const Solved high =
      solve_32(_mm512_loadu_si512(top + 64), _mm512_loadu_si512(bottom + 64), solve);
  store_all<streaming>(to.shear_x + 32, high.shear_x, solve.shear_scale);
  store_all<streaming>(to.shear_y + 32, high.shear_y, solve.shear_scale);
  store_all<streaming>(to.normal + 32, high.normal, solve.normal_scale);
  const __m512i status = _mm512_inserti64x4(_mm512_castsi256_si512(low.status), high.status, 1);
  if (streaming) {
    _mm512_stream_si512(reinterpret_cast<__m512i*>(to.status), status);
  } else {
    _mm512_storeu_si512(to.status, status);
  }
}

/// `count` pillars, below 33.
PF_AVX512 void solve_some(const std::uint8_t* top, const std::uint8_t* bottom, std::uint32_t count,
                          const EighthCounts& solve, const ForcePlanes& to) {
  const auto which = static_cast<__mmask32>((std::uint64_t{1} << count) - 1);
  const __mmask64 sensels = count == 32 ? ~__mmask64{0} : (__mmask64{1} << 2 * count) - 1;
  const Solved solved = solve_32(_mm512_maskz_loadu_epi8(sensels, top),
                                 _mm512_maskz_loadu_epi8(sensels, bottom), solve);
  store_some(to.shear_x, solved.shear_x, solve.shear_scale, which);
  store_some(to.shear_y, solved.shear_y, solve.shear_scale, which);
  store_some(to.normal, solved.normal, solve.normal_scale, which);
  _mm256_mask_storeu_epi8(to.status, which, solved.status);
}

/// A row of pillars.
struct Row {
  const std::uint8_t* top;
  const std::uint8_t* bottom;
  ForcePlanes to;
};

/// What is left of a row from pillar `col` on.
PF_AVX512 Row from(const Row& row, std::size_t col) {
  return {row.top + 2 * col, row.bottom + 2 * col, advanced(row.to, col)};
}

/// The pillars from `col` to before `end`, whichever lines they lie in.
PF_AVX512 void solve_range(const Row& row, std::uint32_t col, std::uint32_t end,
                           const EighthCounts& solve) {
  while (col < end) {
    const std::uint32_t count = end - col < 32 ? end - col : 32;
    const Row rest = from(row, col);
    solve_some(rest.top, rest.bottom, count, solve, rest.to);
    col += count;
  }
}

/// `head` pillars lie before the first whole line of the row.
template <bool streaming>
PF_AVX512 void solve_row(const Row& row, std::uint32_t head, std::uint32_t cols,
                         const EighthCounts& solve) {
  std::uint32_t col = head < cols ? head : cols;
  solve_range(row, 0, col, solve);
  for (; col + 64 <= cols; col += 64) {
    const Row rest = from(row, col);
    ask_ahead<64>(rest.top, rest.bottom);
    solve_64<streaming>(rest.top, rest.bottom, solve, rest.to);
  }
  solve_range(row, col, cols, solve);
}

template <bool streaming>
__attribute__((target("avx512f,avx512bw,avx512vl"))) void solve_rows(const BareSolve& solve,
                                                                     const FrameView& frame,
                                                                     std::uint32_t first,
                                                                     std::uint32_t last,
                                                                     const ForcePlanes& to) {
  const EighthCounts constants(solve);
  const auto* const readings = static_cast<const std::uint8_t*>(frame.data);
  const std::uint32_t cols = frame.cols / 2;
  for (std::size_t row = first; row < last; ++row) {
    const std::uint8_t* const top = readings + 2 * row * frame.row_stride;
    const std::size_t index = row * cols;
    // Cache lines of all planes begin where the index is a multiple of 64.
    const auto head = static_cast<std::uint32_t>(-index % 64);
    solve_row<streaming>({top, top + frame.row_stride, advanced(to, index)}, head, cols, constants);
  }
  if (streaming) _mm_sfence();
}

}  // namespace

void solve_rows_avx512_cached(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                              std::uint32_t last, const ForcePlanes& to) {
  solve_rows<false>(solve, frame, first, last, to);
}

void solve_rows_avx512_streaming(const BareSolve& solve, const FrameView& frame,
                                 std::uint32_t first, std::uint32_t last, const ForcePlanes& to) {
  solve_rows<true>(solve, frame, first, last, to);
}

}  // namespace pillarfield::bench
#endif
