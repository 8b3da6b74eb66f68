#include "bench/timing/copy_source.h"

#include <fmt/format.h>

namespace pillarfield::bench {
namespace {

/// Prefetches 4096 bytes ahead of each read.
constexpr const char* kPrefetching = R"(
#define READ_AHEAD 4096
#if PREFETCHING && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define PREFETCH_TO_READ(pointer) __builtin_prefetch((const void*)((size_t)(pointer) + READ_AHEAD))
#endif
#endif
#ifndef PREFETCH_TO_READ
#define PREFETCH_TO_READ(pointer)
#endif
)";

/// Reads one word of one pillar, or 16 words of 16 pillars: a function for each type of value.
constexpr const char* kReading = R"(
#define uchar_of_one(p, q) as_uint((uchar4)((p)[0], (p)[1], (q)[0], (q)[1]))
#define ushort_of_one(p, q) \
  (as_uint((ushort2)((p)[0], (p)[1])) ^ as_uint((ushort2)((q)[0], (q)[1])))
#define float_of_one(p, q) \
  (as_uint((p)[0]) ^ as_uint((p)[1]) ^ as_uint((q)[0]) ^ as_uint((q)[1]))

uint16 uchar_of_many(global const uchar* p, global const uchar* q) {
  PREFETCH_TO_READ(p);
  PREFETCH_TO_READ(q);
  return (uint16)(as_uint4(vload16(0, p)), as_uint4(vload16(1, p)), as_uint4(vload16(0, q)),
                  as_uint4(vload16(1, q)));
}
uint16 ushort_of_many(global const ushort* p, global const ushort* q) {
  PREFETCH_TO_READ(p);
  PREFETCH_TO_READ(q);
  return (uint16)(as_uint8(vload16(0, p)), as_uint8(vload16(1, p))) ^
         (uint16)(as_uint8(vload16(0, q)), as_uint8(vload16(1, q)));
}
uint16 float_of_many(global const float* p, global const float* q) {
  PREFETCH_TO_READ(p);
  PREFETCH_TO_READ(p + 16);
  PREFETCH_TO_READ(q);
  PREFETCH_TO_READ(q + 16);
  return as_uint16(vload16(0, p)) ^ as_uint16(vload16(1, p)) ^ as_uint16(vload16(0, q)) ^
         as_uint16(vload16(1, q));
}

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

/* `at` is the index of a pillar's upper left sensel in the calibration planes. */
#define FOLD_ALL(words, how)                                                                \
  words = JOIN(SENSEL, how)(first, first + row_stride);                                     \
  if (MASK) words ^= JOIN(uchar, how)(mask + at, mask + at + stride);                       \
  for (int plane = 0; plane < CALIBRATION_PLANES; ++plane) {                                \
    words ^= JOIN(float, how)(calibration + plane * calibration_pitch + at,                 \
                              calibration + plane * calibration_pitch + at + stride);       \
  }
)";

constexpr const char* kWriting = R"(
#if STREAMING && defined(__has_builtin)
#if __has_builtin(__builtin_nontemporal_store)
#define STREAM(value, type, pointer) __builtin_nontemporal_store(value, (global type*)(pointer))
#endif
#endif

/* A vector without alignment: drivers split vstore16. */
typedef float16 ResultsAnywhere __attribute__((aligned(4)));

void write_one(uint word, global float* results, ulong pitch, global uchar* status) {
  for (int plane = 0; plane < RESULT_PLANES; ++plane) results[plane * pitch] = as_float(word);
  *status = (uchar)(word ^ word >> 8 ^ word >> 16 ^ word >> 24);
}

void write_many(uint16 words, global float* results, ulong pitch, global uchar* status) {
  const uint8 half_words = words.lo ^ words.hi;
  const uchar16 bytes = as_uchar16(half_words.lo ^ half_words.hi);
  for (int plane = 0; plane < RESULT_PLANES; ++plane) {
#ifdef STREAM
    STREAM(as_float16(words), float16, results + plane * pitch);
#else
    *(global ResultsAnywhere*)(results + plane * pitch) = as_float16(words);
#endif
  }
  vstore16(bytes, 0, status);
}

void follow_one(uint word, global float* upper, global float* lower) {
  upper[0] = upper[1] = lower[0] = lower[1] = as_float(word);
}

void follow_many(uint16 words, global float* upper, global float* lower) {
  vstore16(as_float16(words), 0, upper);
  vstore16(as_float16(words), 1, upper);
  vstore16(as_float16(words), 0, lower);
  vstore16(as_float16(words), 1, lower);
}
)";

/// Nontemporal stores need aligned addresses: pillars before the first aligned one, and the rest of
/// a row, are copied one by one.
constexpr const char* kEntryPoints = R"(
kernel void copy_streams(global const SENSEL* restrict raw, ulong row_stride, uint pillar_cols,
                         global const float* calibration, ulong calibration_pitch,
                         global const uchar* restrict mask, ulong stride,
                         global float* restrict results, ulong pitch,
                         global uchar* restrict status, global float* tare) {
  const size_t row = get_global_id(1);
#if LANES == 1
  const uint begin = get_global_id(0);
  const uint end = min(begin + 1, pillar_cols);
  const uint aligned = end;
#else
  const uint begin = 0;
  const uint end = pillar_cols;
#ifdef STREAM
  const uint aligned = min(end, (uint)(-(row * pillar_cols) & 15));
#else
  const uint aligned = 0;
#endif
#endif
  uint col = begin;
  while (col < end) {
    global const SENSEL* const first = raw + 2 * row * row_stride + 2 * col;
    const size_t at = 2 * row * stride + 2 * col;
    const size_t index = row * pillar_cols + col;
#if LANES == 16
    if (col >= aligned && col + 16 <= end) {
      uint16 words;
      FOLD_ALL(words, _of_many)
      write_many(words, results + index, pitch, status + index);
      if (FOLLOW) follow_many(words, tare + at, tare + at + stride);
      col += 16;
      continue;
    }
#endif
    uint word;
    FOLD_ALL(word, _of_one)
    write_one(word, results + index, pitch, status + index);
    if (FOLLOW) follow_one(word, tare + at, tare + at + stride);
    ++col;
  }
}

kernel void empty(void) {}
)";

template <class Value>
std::string define(const char* macro, const Value& value) {
  return fmt::format("#define {} {}\n", macro, value);
}

/// The OpenCL C type of a reading.
const char* sensel_name(SenselType type) {
  if (type == SenselType::u8) return "uchar";
  return type == SenselType::u16 ? "ushort" : "float";
}

}  // namespace

std::string copy_source(const Streams& streams, int lanes, const CopyKind& kind) {
  return define("SENSEL", sensel_name(streams.sensel_type)) + define("MASK", int{streams.mask}) +
         define("CALIBRATION_PLANES", streams.calibration_planes) +
         define("RESULT_PLANES", streams.result_planes) +
         define("FOLLOW", int{streams.tare_follows}) + define("LANES", lanes > 1 ? 16 : 1) +
         define("STREAMING", int{kind.streaming}) + define("PREFETCHING", int{kind.prefetching}) +
         kPrefetching + kReading + kWriting + kEntryPoints;
}

}  // namespace pillarfield::bench
