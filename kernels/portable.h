/* The only file that knows the language, the precision and the number of lanes.
 *
 * It gives kernels/maths four types and three macros. The same text then compiles three ways:
 *
 *              OpenCL C                      C++, PF_PRECISION 32    C++, PF_PRECISION 64
 *   Real       float, or floatN of lanes     float                   double
 *   Mask       int, or intN                  bool                    bool
 *   Bits       char, or charN                int                     int
 *   Word       uint, or uintN                std::uint32_t           none
 *
 *   PF_REAL(x)   the constant x in every lane, of Real's own precision
 *   PF_BITS(x)   the integer x in every lane
 *   PF_WORD(x)   as well
 *   bits_of(m)   all bits where the mask m is true, none elsewhere
 *   mask_of(b)   true where b has any bit
 *   word_of(r)   the bits of r
 *   real_of(w)   what w are the bits of
 *
 * In C++ it is included inside a namespace, once per precision, and so has no guard. OpenCL C takes
 * PF_LANES (1, 2, 4, 8 or 16) from the program's first lines.
 *
 * What may stand in kernels/maths is what means the same in all three: masks joined by && and
 * ||, negated by !; Bits joined by &, | and ~; Words joined by
 * these, ^, +, - and shifts; choices written c ? x : y with both sides of lane
 * type; structs passed by value;
 * + - * /, comparisons, fabs, floor, sqrt, hypot, sin, cos, asin, atan, atan2, pow. No contraction:
 * the device and a host built with -ffp-contract=off then agree bit for bit in all but the last
 * six.
 */
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
static inline Real real_of(Word word) { return as_float(word); }
#else
typedef PF_JOIN(float, PF_LANES) Real;
typedef PF_JOIN(int, PF_LANES) Mask;
typedef PF_JOIN(char, PF_LANES) Bits;
typedef PF_JOIN(uint, PF_LANES) Word;
static inline Bits bits_of(Mask mask) { return PF_JOIN(convert_char, PF_LANES)(mask); }
static inline Mask mask_of(Bits bits) { return PF_JOIN(convert_int, PF_LANES)(bits != (Bits)(0)); }
static inline Word word_of(Real value) { return PF_JOIN(as_uint, PF_LANES)(value); }
static inline Real real_of(Word word) { return PF_JOIN(as_float, PF_LANES)(word); }
#endif
#define PF_REAL(x) ((Real)(x##f))
#define PF_BITS(x) ((Bits)(x))
#define PF_WORD(x) ((Word)(x##u))

#else /* C++ */

#undef PF_REAL
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
static inline Real real_of(Word word) { return std::bit_cast<Real>(word); }
#endif
using Mask = bool;
using Bits = int;
#define PF_BITS(x) (x)
static inline Bits bits_of(Mask mask) { return mask ? -1 : 0; }
static inline Mask mask_of(Bits bits) { return bits != 0; }

using std::asin;
using std::atan;
using std::atan2;
using std::cos;
using std::fabs;
using std::floor;
using std::hypot;
using std::pow;
using std::sin;
using std::sqrt;

#endif
