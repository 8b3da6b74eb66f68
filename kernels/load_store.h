/* How values of PF_LANES pillars at once come from memory and go there. For the entry points;
 * PF_LANES and PF_SENSEL are of the program's first lines. */

/* Structures of lanes go through memory wherever a call remains. */
#define PF_INLINE static inline __attribute__((always_inline))

/* The values of `PF_LANES` pillars in one row of sensels. */
typedef struct {
  Real left;
  Real right;
} RealPair;

#ifdef PF_WHOLE
typedef struct {
  Counts left;
  Counts right;
} CountsPair;
#else
typedef RealPair CountsPair;
#endif

#define PF_LANE_TYPE(type) PF_JOIN(type, PF_LANES)
#define PF_VLOAD PF_JOIN(vload, PF_LANES)
#define PF_VSTORE PF_JOIN(vstore, PF_LANES)

/* Vectors at any address. Drivers take those of vload and vstore apart (PoCL 3.1: bytes one by one,
 * 16 floats into three), but not a member of a packed structure. */
#if PF_LANES > 1
#define PF_DEFINE_PACKED(type)             \
  typedef struct __attribute__((packed)) { \
    PF_LANE_TYPE(type) value;              \
  } packed_##type;
PF_DEFINE_PACKED(uchar)
PF_DEFINE_PACKED(ushort)
PF_DEFINE_PACKED(float)
#define PF_LOAD_WHOLE(type, place) (((global const packed_##type*)(place))->value)
#define PF_STORE_WHOLE(type, lanes, place) ((global packed_##type*)(place))->value = (lanes)
#endif

/* load_<name>(row, count): the sensels under `count` neighbouring pillars, as Real; readings as
 * Counts. Where a row has fewer than PF_LANES, nothing beyond it is read, and the other lanes are
 * zero. */
#if PF_LANES == 1
#define PF_DEFINE_LOAD(name, type, Pair, split)                    \
  PF_INLINE Pair load_##name(global const type* row, uint count) { \
    Pair pair;                                                     \
    pair.left = (Real)row[0];                                      \
    pair.right = (Real)row[1];                                     \
    return pair;                                                   \
  }
#else

#define PF_DEFINE_LOAD(name, type, Pair, split)                                           \
  PF_INLINE Pair load_##name(global const type* row, uint count) {                        \
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

#ifdef PF_WHOLE
/* Both readings of a pillar are one integer, as above; `count` is PF_LANES. */
PF_INLINE CountsPair load_readings(global const uchar* row, uint count) {
  const PF_LANE_TYPE(ushort) both = PF_LOAD_WHOLE(ushort, row);
  const PF_LANE_TYPE(short) lower = PF_JOIN(as_short, PF_LANES)(both & (ushort)0xff);
  const PF_LANE_TYPE(short) upper = PF_JOIN(as_short, PF_LANES)(both >> 8);
#ifdef __ENDIAN_LITTLE__
  const CountsPair pair = {lower * (short)PF_WHOLE, upper * (short)PF_WHOLE};
#else
  const CountsPair pair = {upper * (short)PF_WHOLE, lower * (short)PF_WHOLE};
#endif
  return pair;
}
#else
PF_DEFINE_LOAD(readings, PF_SENSEL, RealPair, PF_JOIN(split_, PF_SENSEL))
#endif
PF_DEFINE_LOAD(plane, float, RealPair, split_float)
PF_DEFINE_LOAD(mask, uchar, RealPair, split_uchar)

/* Whether there is any bit in any lane. `any` goes through the lanes' signs instead. */
PF_INLINE bool any_bit(Bits bits) {
#if PF_LANES == 16
  const ulong2 words = as_ulong2(bits);
  return (words.s0 | words.s1) != 0;
#elif PF_LANES == 8
  return as_ulong(bits) != 0;
#elif PF_LANES == 4
  return as_uint(bits) != 0;
#elif PF_LANES == 2
  return as_ushort(bits) != 0;
#else
  return bits != 0;
#endif
}

/* Whether a mask is true in any lane. */
PF_INLINE bool any_lane(Mask mask) {
#if PF_LANES == 1
  return mask;
#else
  return any_bit(bits_of(mask));
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

/* Writes the first `count` lanes. */
PF_INLINE void store_plane(Real value, global float* plane, uint count) {
#if PF_LANES == 1
  *plane = value;
#else
  if (count == PF_LANES) {
    PF_STORE_WHOLE(float, value, plane);
  } else {
    float lanes[PF_LANES];
    PF_VSTORE(value, 0, lanes);
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
    PF_STORE_WHOLE(uchar, bytes, plane);
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
