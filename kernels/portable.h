/* The only file that depends on the language, the precision and the number of lanes.
 *
 * It defines types, macros and conversions with which kernels/pillar compiles in four ways, and
 * kernels/frame in the first and the last:
 *
 *            OpenCL C                   and PF_WHOLE   C++      PF_PRECISION 64   C++ with PF_LANES
 *   Real     float, or floatN of lanes  floatN         float    double            vectors of float
 *   Counts   as Real                    shortN         float    double            as Real
 *   Fraction as Real                    short          float    double            as Real
 *   Mask     int, or intN               shortN         bool     bool              vectors of int
 *   Bits     char, or charN             charN          int      int               as Mask
 *   Word     uint, or uintN             uintN          uint32   none              vectors of uint32
 *
 * The last are the vectors of g++ and clang++; with PF_WHOLE Counts and Mask are vectors of short.
 *
 *   PF_REAL(x)    the constant x in every lane, of Real's own precision
 *   PF_COUNTS(x)  the whole constant x in every lane
 *   PF_BITS(x)    the integer x in every lane
 *   PF_WORD(x)    the unsigned constant x in every lane
 *   halved(c)    c / 2
 *   fraction_of(c, f)  c times f, of a Fraction, where c is not negative
 *   real_of(c)    c as Real
 *   bits_of(m)    all bits where the mask m is true, none elsewhere
 *   mask_of(b)    true where b has any bit
 *   any_lane(m)   true if m is true in any lane
 *   PF_CONSTANT(T, x)  the constant x of a program or plan in every lane of a T
 *   PF_INLINE     specifier of a function of lanes; PoCL always inlines it
 *   PF_UNROLL     before a loop of few iterations: PoCL unrolls it, else its arrays stay in memory
 *
 *   word_of(r)    the bits of r
 *   real_of_word(w)  the Real whose bits are w
 *   real_of_count(w)  the number w as Real
 *
 * Counts are readings, their sums and differences. With PF_WHOLE they are whole numbers of
 * 1 / PF_WHOLE counts, which is exact for 8-bit readings without calibration, and whose lanes are
 * half as wide (docs/derivations/direct_solve.md, section 6); no sensel is then missing, a Fraction
 * is the number n of 1 - 1 / 2^n, and only pillar_model.h, sensel.h and direct_solve.h are used.
 *
 * C++ includes it inside a namespace, once per precision, or with PF_LANES inside a struct whose
 * members are the numbers of a plan; it therefore has no guard. In OpenCL C the program's first
 * lines define PF_LANES (1, 2, 4, 8 or 16) and PF_WHOLE; PF_SCALAR is then defined for a single
 * lane, which is not a vector.
 *
 * kernels/pillar uses only expressions with one meaning in all four: masks joined by && and
 * ||, negated by !; Bits joined by &, | and ~; Words joined by these, ^, +, - and shifts;
 * selections written c ? x : y with both sides of lane type; structs passed by value; of Counts in
 * programs of whole numbers + - and comparisons alone; if (any_lane(mask)) where the skipped code
 * changes no bit; + - * /, comparisons, fabs, copysign, floor, sqrt, hypot, sin, cos, asin, atan,
 * atan2, pow (only in double precision). No contraction: the device and a host built with
 * -ffp-contract=off then agree bit for bit in all but the last six. */
#ifndef __cplusplus /* OpenCL C */

#pragma OPENCL FP_CONTRACT OFF

#define PF_JOIN_(a, b) a##b
#define PF_JOIN(a, b) PF_JOIN_(a, b)
#if PF_LANES == 1
#define PF_SCALAR
typedef float Real;
typedef int Mask;
typedef char Bits;
typedef uint Word;
static inline Bits bits_of(Mask mask) { return mask ? -1 : 0; }
static inline Mask mask_of(Bits bits) { return bits != 0; }
static inline Word word_of(Real value) { return as_uint(value); }
static inline Real real_of_word(Word word) { return as_float(word); }
static inline Real real_of_count(Word count) { return (Real)count; }
#else
#ifdef PF_WHOLE
#define PF_MASK_LANE short
#else
#define PF_MASK_LANE int
#endif
typedef PF_JOIN(float, PF_LANES) Real;
typedef PF_JOIN(PF_MASK_LANE, PF_LANES) Mask;
typedef PF_JOIN(char, PF_LANES) Bits;
typedef PF_JOIN(uint, PF_LANES) Word;
static inline Bits bits_of(Mask mask) { return PF_JOIN(convert_char, PF_LANES)(mask); }
static inline Mask mask_of(Bits bits) {
  return PF_JOIN(PF_JOIN(convert_, PF_MASK_LANE), PF_LANES)(bits != (Bits)(0));
}
static inline Word word_of(Real value) { return PF_JOIN(as_uint, PF_LANES)(value); }
static inline Real real_of_word(Word word) { return PF_JOIN(as_float, PF_LANES)(word); }
static inline Real real_of_count(Word count) { return PF_JOIN(convert_float, PF_LANES)(count); }
#endif

#ifdef PF_WHOLE
typedef PF_JOIN(short, PF_LANES) Counts;
typedef short Fraction;
static inline Counts halved(Counts counts) { return counts >> 1; }
static inline Counts fraction_of(Counts counts, Fraction fraction) {
  return counts - (counts >> (Counts)(fraction));
}
static inline Real real_of(Counts counts) { return PF_JOIN(convert_float, PF_LANES)(counts); }
#else
typedef Real Counts;
typedef Real Fraction;
static inline Counts halved(Counts counts) { return 0.5f * counts; }
static inline Counts fraction_of(Counts counts, Fraction fraction) { return fraction * counts; }
static inline Real real_of(Counts counts) { return counts; }
#endif
/* True if any lane has any bit set. (Drivers' any() tests one lane after the other.) */
static inline bool any_bits(Bits bits) {
#if PF_LANES == 1
  return bits != 0;
#elif PF_LANES == 2
  return as_short(bits) != 0;
#elif PF_LANES == 4
  return as_int(bits) != 0;
#elif PF_LANES == 8
  return as_long(bits) != 0;
#else
  const long2 halves = as_long2(bits);
  return (halves.x | halves.y) != 0;
#endif
}

static inline bool any_lane(Mask mask) { return any_bits(bits_of(mask)); }

/* PoCL does not inline by itself, and passes structures of lanes through memory. Other drivers
 * inline; Oclgrind lacks the attribute. */
#ifdef POCL_DEVICE_ADDRESS_BITS
#define PF_INLINE static inline __attribute__((always_inline))
#define PF_UNROLL _Pragma("unroll")
#else
#define PF_INLINE static inline
#define PF_UNROLL
#endif

#define PF_CONSTANT(type, x) ((type)(x))
#define PF_REAL(x) ((Real)(x##f))
#define PF_COUNTS(x) ((Counts)(x))
#define PF_BITS(x) ((Bits)(x))
#define PF_WORD(x) ((Word)(x##u))

#elif defined(PF_LANES) /* C++ with vectors, members of a struct */

#define PF_INLINE inline __attribute__((always_inline))
#define PF_UNROLL
#undef PF_CONSTANT
#undef PF_REAL
#undef PF_COUNTS
#undef PF_BITS
#undef PF_WORD
#define PF_LANES_OF(type) __attribute__((vector_size(sizeof(type) * PF_LANES))) type
typedef PF_LANES_OF(float) Real;
typedef PF_LANES_OF(uint) Word;
#ifdef PF_WHOLE
typedef PF_LANES_OF(short) Mask;
typedef Mask Counts;
typedef short Fraction;
#else
typedef PF_LANES_OF(int) Mask;
typedef Real Counts;
typedef Real Fraction;
#endif
typedef Mask Bits;
/* A number in every lane; a vector stays. */
template <class To, class From>
PF_INLINE To in_lanes(From x) {
  if constexpr (std::is_arithmetic_v<To> || std::is_same_v<From, To>) {
    return static_cast<To>(x);
  } else {
    return static_cast<std::remove_cvref_t<decltype(To{}[0])> >(x) - To{};
  }
}
#define PF_CONSTANT(type, x) in_lanes<type>(x)
#define PF_REAL(x) in_lanes<Real>(x##f)
#define PF_COUNTS(x) in_lanes<Counts>(x)
#define PF_BITS(x) in_lanes<Bits>(x)
#define PF_WORD(x) in_lanes<Word>(x##u)
PF_INLINE Bits bits_of(Mask mask) { return mask; }
PF_INLINE Mask mask_of(Bits bits) { return bits != 0; }
PF_INLINE Word word_of(Real value) { return (Word)value; }
PF_INLINE Real real_of_word(Word word) { return (Real)word; }
PF_INLINE Real real_of_count(Word count) { return __builtin_convertvector(count, Real); }
#ifdef PF_WHOLE
PF_INLINE Counts halved(Counts counts) { return counts >> 1; }
PF_INLINE Counts fraction_of(Counts counts, Fraction fraction) {
  return counts - (counts >> fraction);
}
PF_INLINE Real real_of(Counts counts) { return __builtin_convertvector(counts, Real); }
#else
PF_INLINE Counts halved(Counts counts) { return 0.5f * counts; }
PF_INLINE Counts fraction_of(Counts counts, Fraction fraction) { return fraction * counts; }
PF_INLINE Real real_of(Counts counts) { return counts; }
#endif
/* True if any lane has any bit set. */
template <class Vector>
PF_INLINE bool any_bits(Vector bits) {
  ulong parts[(sizeof(Vector) + sizeof(ulong) - 1) / sizeof(ulong)] = {};
  __builtin_memcpy(parts, &bits, sizeof(Vector));
  ulong all = 0;
  for (const ulong part : parts) all |= part;
  return all != 0;
}
PF_INLINE bool any_lane(Mask mask) { return any_bits(mask); }
PF_INLINE float fabs(float x) { return __builtin_fabsf(x); }
PF_INLINE Real fabs(Real x) { return real_of_word(word_of(x) & PF_WORD(0x7fffffff)); }
PF_INLINE Real copysign(Real x, Real y) {
  return real_of_word((word_of(x) & PF_WORD(0x7fffffff)) | (word_of(y) & PF_WORD(0x80000000)));
}
#define PF_DEFINE_BY_LANES(name, function)                                   \
  PF_INLINE Real name(Real x) {                                              \
    for (int lane = 0; lane < PF_LANES; ++lane) x[lane] = function(x[lane]); \
    return x;                                                                \
  }
PF_DEFINE_BY_LANES(sqrt, __builtin_sqrtf)
PF_DEFINE_BY_LANES(floor, __builtin_floorf)
PF_DEFINE_BY_LANES(sin, __builtin_sinf)
PF_DEFINE_BY_LANES(cos, __builtin_cosf)
PF_DEFINE_BY_LANES(asin, __builtin_asinf)
PF_DEFINE_BY_LANES(atan, __builtin_atanf)
#undef PF_DEFINE_BY_LANES
PF_INLINE Real atan2(Real y, Real x) {
  for (int lane = 0; lane < PF_LANES; ++lane) y[lane] = __builtin_atan2f(y[lane], x[lane]);
  return y;
}

#else /* C++ */

#define PF_INLINE static inline
#define PF_UNROLL
#define PF_CONSTANT(type, x) static_cast<type>(x)
#undef PF_REAL
#undef PF_COUNTS
#undef PF_BITS
#undef PF_WORD
#if PF_PRECISION == 64
using Real = double;
#define PF_REAL(x) (x)
#else
using Real = float;
#define PF_REAL(x) (x##f)
#define PF_WORD(x) (x##U)
using Word = std::uint32_t;
static inline Word word_of(Real value) { return std::bit_cast<Word>(value); }
static inline Real real_of_word(Word word) { return std::bit_cast<Real>(word); }
static inline Real real_of_count(Word count) { return static_cast<Real>(count); }
#endif
using Counts = Real;
using Fraction = Real;
using Mask = bool;
using Bits = int;
using ulong = std::uint64_t;
#define PF_COUNTS(x) (static_cast<Counts>(x))
#define PF_BITS(x) (x)
static inline Counts halved(Counts counts) { return PF_REAL(0.5) * counts; }
static inline Counts fraction_of(Counts counts, Fraction fraction) { return fraction * counts; }
static inline Real real_of(Counts counts) { return counts; }
static inline Bits bits_of(Mask mask) { return mask ? -1 : 0; }
static inline Mask mask_of(Bits bits) { return bits != 0; }
static inline bool any_lane(Mask mask) { return mask; }

using std::asin;
using std::atan;
using std::atan2;
using std::copysign;
using std::cos;
using std::fabs;
using std::floor;
using std::hypot;
using std::pow;
using std::sin;
using std::sqrt;

#endif
