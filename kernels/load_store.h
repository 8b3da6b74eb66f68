/* How values of PF_LANES pillars at once come from memory and go there. For the entry points;
 * PF_LANES and PF_SENSEL are of the program's first lines. */

/* Structures of lanes go through memory wherever a call remains. */
#define PF_INLINE static inline __attribute__((always_inline))

/* The values of `PF_LANES` pillars in one row of sensels. */
typedef struct {
  Real left;
  Real right;
} RealPair;

#define PF_LANE_TYPE(type) PF_JOIN(type, PF_LANES)
#define PF_VLOAD PF_JOIN(vload, PF_LANES)
#define PF_VSTORE PF_JOIN(vstore, PF_LANES)

/* load_<name>(row, count): the sensels under `count` neighbouring pillars, as Real. Where a row has
 * fewer than PF_LANES, nothing beyond it is read, and the other lanes are zero. */
#if PF_LANES == 1
#define PF_DEFINE_LOAD(name, type, split)                              \
  PF_INLINE RealPair load_##name(global const type* row, uint count) { \
    RealPair pair;                                                     \
    pair.left = (Real)row[0];                                          \
    pair.right = (Real)row[1];                                         \
    return pair;                                                       \
  }
#else

#define PF_DEFINE_LOAD(name, type, split)                                                 \
  PF_INLINE RealPair load_##name(global const type* row, uint count) {                    \
    if (count == PF_LANES) return split(PF_VLOAD(0, row), PF_VLOAD(1, row));              \
    type padded[2 * PF_LANES];                                                            \
    for (uint i = 0; i < 2 * PF_LANES; ++i) padded[i] = i < 2 * count ? row[i] : (type)0; \
    return split(PF_VLOAD(0, padded), PF_VLOAD(1, padded));                               \
  }

#define PF_TO_REAL PF_JOIN(convert_float, PF_LANES)

/* Left and right sensels alternate in memory. */
#define PF_DEFINE_SPLIT(type)                                                        \
  PF_INLINE RealPair split_##type(PF_LANE_TYPE(type) low, PF_LANE_TYPE(type) high) { \
    RealPair pair;                                                                   \
    pair.left = PF_TO_REAL((PF_LANE_TYPE(type))(low.even, high.even));               \
    pair.right = PF_TO_REAL((PF_LANE_TYPE(type))(low.odd, high.odd));                \
    return pair;                                                                     \
  }
PF_DEFINE_SPLIT(float)

#ifdef __ENDIAN_LITTLE__
/* Two neighbours of a short type are one integer, whose lower half is the left one: taken apart so
 * they cost half the instructions of a shuffle. */
#if PF_LANES == 16
#define PF_HALF_LANES 8
#elif PF_LANES == 8
#define PF_HALF_LANES 4
#elif PF_LANES == 4
#define PF_HALF_LANES 2
#else
#define PF_HALF_LANES
#endif
#define PF_DEFINE_SPLIT_OF_INTEGERS(type, wide, bits)                                      \
  PF_INLINE RealPair split_##type(PF_LANE_TYPE(type) low, PF_LANE_TYPE(type) high) {       \
    const PF_LANE_TYPE(uint) both = PF_JOIN(convert_uint, PF_LANES)((PF_LANE_TYPE(wide))(  \
        PF_JOIN(as_##wide, PF_HALF_LANES)(low), PF_JOIN(as_##wide, PF_HALF_LANES)(high))); \
    RealPair pair;                                                                         \
    pair.left = PF_TO_REAL(PF_JOIN(as_int, PF_LANES)(both & ((1u << bits) - 1u)));         \
    pair.right = PF_TO_REAL(PF_JOIN(as_int, PF_LANES)(both >> bits));                      \
    return pair;                                                                           \
  }
PF_DEFINE_SPLIT_OF_INTEGERS(uchar, ushort, 8u)
PF_DEFINE_SPLIT_OF_INTEGERS(ushort, uint, 16u)
#else
PF_DEFINE_SPLIT(uchar)
PF_DEFINE_SPLIT(ushort)
#endif
#endif

PF_DEFINE_LOAD(readings, PF_SENSEL, PF_JOIN(split_, PF_SENSEL))
PF_DEFINE_LOAD(plane, float, split_float)
PF_DEFINE_LOAD(mask, uchar, split_uchar)

/* Whether a mask is true in any lane. */
PF_INLINE bool any_lane(Mask mask) {
#if PF_LANES == 1
  return mask;
#else
  return any(mask);
#endif
}

/* Brings the values of PF_LANES pillars in one row of sensels towards the caches. What may lie past
 * the end of a plane is not touched by it; where a compiler has no word for it, nothing happens. */
#if PF_LANES > 1 && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#define PF_PREFETCH(row)                                                       \
  for (size_t byte_ = 0; byte_ < 2 * PF_LANES * sizeof(*(row)); byte_ += 64) { \
    __builtin_prefetch((const void*)((size_t)(row) + byte_));                  \
  }
#endif
#endif
#ifndef PF_PREFETCH
#define PF_PREFETCH(row)
#endif

/* store_<name>(pair, row, count): writes what load_<name> reads; whole values where type has no
 * fractions. */
#if PF_LANES == 1
#define PF_DEFINE_STORE(name, type)                                          \
  PF_INLINE void store_##name(RealPair pair, global type* row, uint count) { \
    row[0] = (type)pair.left;                                                \
    row[1] = (type)pair.right;                                               \
  }
#else
#define PF_DEFINE_STORE(name, type)                                                          \
  PF_INLINE void store_##name(RealPair pair, global type* row, uint count) {                 \
    const PF_LANE_TYPE(type) left = PF_JOIN(PF_JOIN(convert_, type), PF_LANES)(pair.left);   \
    const PF_LANE_TYPE(type) right = PF_JOIN(PF_JOIN(convert_, type), PF_LANES)(pair.right); \
    PF_LANE_TYPE(type) low, high;                                                            \
    low.even = left.lo;                                                                      \
    low.odd = right.lo;                                                                      \
    high.even = left.hi;                                                                     \
    high.odd = right.hi;                                                                     \
    if (count == PF_LANES) {                                                                 \
      PF_VSTORE(low, 0, row);                                                                \
      PF_VSTORE(high, 1, row);                                                               \
    } else {                                                                                 \
      type values[2 * PF_LANES];                                                             \
      PF_VSTORE(low, 0, values);                                                             \
      PF_VSTORE(high, 1, values);                                                            \
      for (uint i = 0; i < 2 * count; ++i) row[i] = values[i];                               \
    }                                                                                        \
  }
#endif

PF_DEFINE_STORE(pair, float)
PF_DEFINE_STORE(readings, PF_SENSEL)

/* A value of a result, and as many as there are lanes. */
#ifdef PF_HALF
typedef ushort Result;
#else
typedef float Result;
#endif
#if PF_LANES == 1
typedef Result Results;
#elif defined(PF_HALF)
typedef PF_LANE_TYPE(ushort) Results;
/* PoCL's vstore takes vectors of short values apart. */
typedef Results ResultsAnywhere __attribute__((aligned(2)));
#define PF_STORE_RESULTS(results, plane) (*(global ResultsAnywhere*)(plane) = (results))
#else
typedef Real Results;
#define PF_STORE_RESULTS(results, plane) PF_VSTORE(results, 0, plane)
#endif

/* As the planes of a result have them. */
PF_INLINE Results results_of(Real value) {
#ifndef PF_HALF
  return value;
#elif PF_LANES == 1
  return (ushort)half_bits(value);
#elif defined(__F16C__)
  /* An instruction of the processor that rounds as half_bits does, to which no function of OpenCL C
   * leads that returns a value. */
  typedef __fp16 Halves __attribute__((ext_vector_type(PF_LANES)));
  return __builtin_astype(__builtin_convertvector(value, Halves), Results);
#else
  return PF_JOIN(convert_ushort, PF_LANES)(half_bits(value));
#endif
}

/* Writes the first `count` lanes. */
PF_INLINE void store_plane(Real value, global Result* plane, uint count) {
  const Results results = results_of(value);
#if PF_LANES == 1
  *plane = results;
#else
  if (count == PF_LANES) {
    PF_STORE_RESULTS(results, plane);
  } else {
    Result lanes[PF_LANES];
    PF_VSTORE(results, 0, lanes);
    for (uint i = 0; i < count; ++i) plane[i] = lanes[i];
  }
#endif
}

PF_INLINE void store_status(Bits value, global uchar* plane, uint count) {
#if PF_LANES == 1
  *plane = (uchar)value;
#else
  const PF_LANE_TYPE(uchar) bytes = PF_JOIN(as_uchar, PF_LANES)(value);
  if (count == PF_LANES) {
    PF_VSTORE(bytes, 0, plane);
  } else {
    uchar lanes[PF_LANES];
    PF_VSTORE(bytes, 0, lanes);
    for (uint i = 0; i < count; ++i) plane[i] = lanes[i];
  }
#endif
}

/* The status bytes of PF_LANES pillars from column `col` on, which may lie outside the row: what is
 * beyond its ends is zero. */
PF_INLINE Bits load_status(global const uchar* row, int col, uint cols) {
#if PF_LANES == 1
  return col >= 0 && (uint)col < cols ? (Bits)row[col] : (Bits)0;
#else
  if (col >= 0 && (uint)col + PF_LANES <= cols) {
    return PF_JOIN(as_char, PF_LANES)(PF_VLOAD(0, row + col));
  }
  uchar padded[PF_LANES];
  for (uint i = 0; i < PF_LANES; ++i) {
    const int at = col + (int)i;
    padded[i] = at >= 0 && (uint)at < cols ? row[at] : (uchar)0;
  }
  return PF_JOIN(as_char, PF_LANES)(PF_VLOAD(0, padded));
#endif
}
