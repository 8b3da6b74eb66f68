/* Rounding to IEEE half precision: results that move fewer bytes. Single precision only. */

#if !defined(__cplusplus) || PF_PRECISION == 32

/* The bits of the half that is nearest to `value`, of two the even one: the lower 16 of each word.
 * Halves are normal from 2^-14 on, and multiples of 2^-24 below; from 65520 on the nearest is
 * infinity. NaN stays one, quiet, with the upper bits of its payload. All as vcvtps2ph of x86. */
static inline Word bits_of_half(Real value) {
  const Word infinity = PF_WORD(0x7f800000);
  const Word bits = word_of(value);
  const Word sign = bits & PF_WORD(0x80000000);
  const Word size = bits ^ sign;
  /* 13 bits go, and the exponent counts from 112 less. What is added carries where more than half
   * a unit goes, and where half a unit goes from an odd number. */
  const Word odd = (size >> 13) & PF_WORD(1);
  const Word normal = (size - (PF_WORD(112) << 23) + PF_WORD(0xfff) + odd) >> 13;
  /* The last place of 0.5 is the smallest half, so that the sum is rounded as wanted. */
  const Word one_half = word_of(PF_REAL(0.5));
  const Word subnormal = word_of(real_of_word(size) + PF_REAL(0.5)) - one_half;
  const Word not_a_number = PF_WORD(0x7e00) | ((size >> 13) & PF_WORD(0x3ff));
  const Word finite = size < word_of(PF_REAL(0x1p-14)) ? subnormal : normal;
  const Word endless = size > infinity ? not_a_number : PF_WORD(0x7c00);
  return (size < word_of(PF_REAL(0x1p16)) ? finite : endless) | (sign >> 16);
}

#endif
