/* The only file that depends on the language, the precision and the number of lanes.
 *
 * It defines types, macros and conversions with which kernels/pillar compiles four ways:
 *
 *            OpenCL C                   and PF_WHOLE   C++, PF_PRECISION 32   C++, PF_PRECISION 64
 *   Real     float, or floatN of lanes  floatN         float                  double
 *   Counts   as Real                    shortN         float                  double
 *   Fraction as Real                    short          float                  double
 *   Mask     int, or intN               shortN         bool                   bool
 *   Bits     char, or charN             charN          int                    int
 *   Word     uint, or uintN             uintN          std::uint32_t          none
 *
 *   PF_REAL(x)    the constant x in every lane, of Real's own precision
 *   PF_INFINITY   infinity in every lane, of Real
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
 * C++ includes it inside a namespace, once per precision; it therefore has no guard. In OpenCL C
 * the program's first lines define PF_LANES (1, 2, 4, 8 or 16) and PF_WHOLE.
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
#define PF_INFINITY ((Real)(INFINITY))
#define PF_COUNTS(x) ((Counts)(x))
#define PF_BITS(x) ((Bits)(x))
#define PF_WORD(x) ((Word)(x##u))

#else /* C++ */

#define PF_INLINE static inline
#define PF_UNROLL
#define PF_CONSTANT(type, x) static_cast<type>(x)
#undef PF_REAL
#undef PF_INFINITY
#undef PF_COUNTS
#undef PF_BITS
#undef PF_WORD
#define PF_INFINITY (std::numeric_limits<Real>::infinity())
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
