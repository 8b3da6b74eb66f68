/* Loads and stores of PF_LANES pillars at once, for the entry points. The program's first lines
 * define PF_LANES and PF_SENSEL. */

/* Values of the left and right sensels of PF_LANES pillars in one row of sensels. */
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

/* True where a comparison holds in any lane. */
#define PF_ANY(mask) any_bits(PF_JOIN(convert_char, PF_LANES)(mask))

#ifdef PF_SCALAR
#define PF_LANE_NUMBERS 0.0f
#elif PF_LANES == 2
#define PF_LANE_NUMBERS (Real)(0, 1)
#elif PF_LANES == 4
#define PF_LANE_NUMBERS (Real)(0, 1, 2, 3)
#elif PF_LANES == 8
#define PF_LANE_NUMBERS (Real)(0, 1, 2, 3, 4, 5, 6, 7)
#else
#define PF_LANE_NUMBERS (Real)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#endif

/* Unaligned vectors. Drivers split vload and vstore (PoCL 3.1: bytes one by one, 16 floats into
 * three accesses), but not a member of a packed structure. */
#ifndef PF_SCALAR
#define PF_DEFINE_PACKED(type)             \
  typedef struct __attribute__((packed)) { \
    PF_LANE_TYPE(type) value;              \
  } packed_##type;
PF_DEFINE_PACKED(uchar)
PF_DEFINE_PACKED(ushort)
PF_DEFINE_PACKED(float)
#define PF_LOAD_WHOLE(type, place) (((global const PF_JOIN(packed_, type)*)(place))->value)
#define PF_STORE_WHOLE(type, lanes, place) \
  ((global PF_JOIN(packed_, type)*)(place))->value = (lanes)
#endif

/* load_<name>(row): sensels under PF_LANES pillars, as Real; readings as Counts. */
#ifdef PF_SCALAR
#define PF_DEFINE_LOAD(name, type, Pair, split)        \
  PF_INLINE Pair load_##name(global const type* row) { \
    Pair pair;                                         \
    pair.left = (Real)row[0];                          \
    pair.right = (Real)row[1];                         \
    return pair;                                       \
  }
#else

#define PF_DEFINE_LOAD(name, type, Pair, split)                                  \
  PF_INLINE Pair load_##name(global const type* row) {                           \
    return split(PF_LOAD_WHOLE(type, row), PF_LOAD_WHOLE(type, row + PF_LANES)); \
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
/* Two neighbours of a short type form one integer, whose lower half is the left one. Masking and
 * shifting take half the instructions of a shuffle. */
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
/* Both readings of a pillar form one integer. */
PF_INLINE CountsPair load_readings(global const uchar* row) {
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
#ifdef PF_SCALAR
PF_INLINE RealPair load_private(const float* row) {
  const RealPair pair = {row[0], row[1]};
  return pair;
}
#else
PF_INLINE RealPair load_private(const float* row) {
  return split_float(PF_VLOAD(0, row), PF_VLOAD(1, row));
}
#endif
PF_DEFINE_LOAD(mask, uchar, RealPair, split_uchar)

/* Prefetches the values of PF_LANES pillars in one row of sensels: PF_PREFETCH into the first cache
 * level, for blocks that are solved next; PF_PREFETCH_FAR into the second, which allows more
 * requests in flight, for blocks that are likely idle. Addresses past the end of a plane are
 * harmless. Only PoCL is certain to have the builtin. */
#if !defined(PF_SCALAR) && defined(POCL_DEVICE_ADDRESS_BITS)
#define PF_PREFETCH_SPAN(row, count, locality)                             \
  for (size_t byte_ = 0; byte_ < (count) * sizeof(*(row)); byte_ += 64) {  \
    __builtin_prefetch((const void*)((size_t)(row) + byte_), 0, locality); \
  }
#define PF_PREFETCH_TO(row, locality) PF_PREFETCH_SPAN(row, 2 * PF_LANES, locality)
#define PF_PREFETCH(row) PF_PREFETCH_TO(row, 3)
#define PF_PREFETCH_FAR(row) PF_PREFETCH_TO(row, 2)
#else
#define PF_PREFETCH_SPAN(row, count, locality) ((void)0)
#define PF_PREFETCH(row) ((void)0)
#define PF_PREFETCH_FAR(row) ((void)0)
#endif

/* Range of the lanes of a block that are written. */
typedef struct {
  uint first;
  uint end;
} Lanes;

PF_INLINE bool are_all(Lanes lanes) { return lanes.end - lanes.first == PF_LANES; }

/* store_<name>(pair, row, lanes): writes values in the layout that load_<name> reads; an integer
 * type takes whole values. */
#ifdef PF_SCALAR
#define PF_DEFINE_STORE(name, type)                                           \
  PF_INLINE void store_##name(RealPair pair, global type* row, Lanes lanes) { \
    row[0] = (type)pair.left;                                                 \
    row[1] = (type)pair.right;                                                \
  }
#else
#define PF_DEFINE_STORE(name, type)                                                          \
  PF_INLINE void store_##name(RealPair pair, global type* row, Lanes lanes) {                \
    const PF_LANE_TYPE(type) left = PF_JOIN(PF_JOIN(convert_, type), PF_LANES)(pair.left);   \
    const PF_LANE_TYPE(type) right = PF_JOIN(PF_JOIN(convert_, type), PF_LANES)(pair.right); \
    PF_LANE_TYPE(type) low, high;                                                            \
    low.even = left.lo;                                                                      \
    low.odd = right.lo;                                                                      \
    high.even = left.hi;                                                                     \
    high.odd = right.hi;                                                                     \
    if (are_all(lanes)) {                                                                    \
      PF_STORE_WHOLE(type, low, row);                                                        \
      PF_STORE_WHOLE(type, high, row + PF_LANES);                                            \
    } else {                                                                                 \
      type values[2 * PF_LANES];                                                             \
      PF_VSTORE(low, 0, values);                                                             \
      PF_VSTORE(high, 1, values);                                                            \
      for (uint i = 2 * lanes.first; i < 2 * lanes.end; ++i) row[i] = values[i];             \
    }                                                                                        \
  }
#endif

PF_DEFINE_STORE(pair, float)
PF_DEFINE_STORE(readings, PF_SENSEL)

/* With PF_STREAM, full blocks bypass the caches, for results that exceed them; such blocks are
 * aligned to their size. */
#ifdef PF_SCALAR
#define PF_STORE_BLOCK(results, plane) *(plane) = (results)
#elif defined(PF_STREAM) && defined(POCL_DEVICE_ADDRESS_BITS)
#define PF_STORE_BLOCK(results, plane) __builtin_nontemporal_store(results, (global Real*)(plane))
#else
#define PF_STORE_BLOCK(results, plane) PF_STORE_WHOLE(float, results, plane)
#endif

PF_INLINE void store_plane(Real value, global float* plane, Lanes lanes) {
  if (are_all(lanes)) {
    PF_STORE_BLOCK(value, plane);
  } else {
#ifndef PF_SCALAR
    float values[PF_LANES];
    PF_VSTORE(value, 0, values);
    for (uint i = lanes.first; i < lanes.end; ++i) plane[i] = values[i];
#endif
  }
}

#ifdef PF_SENSELS
/* Writes the values of one row of sensels under PF_LANES pillars, those of `sensels`. */
#ifdef PF_SCALAR
#define PF_DEFINE_STORE_SENSELS(name, Value, type, as, store)                             \
  PF_INLINE void store_##name(Value left, Value right, global type* row, Lanes sensels) { \
    if (sensels.first == 0) row[0] = (type)left;                                          \
    if (sensels.end == 2) row[1] = (type)right;                                           \
  }
#else
#define PF_DEFINE_STORE_SENSELS(name, Value, type, as, store)                             \
  PF_INLINE void store_##name(Value left, Value right, global type* row, Lanes sensels) { \
    PF_LANE_TYPE(type) low, high;                                                         \
    low.even = as(left).lo;                                                               \
    low.odd = as(right).lo;                                                               \
    high.even = as(left).hi;                                                              \
    high.odd = as(right).hi;                                                              \
    if (sensels.end - sensels.first == 2 * PF_LANES) {                                    \
      store(low, row);                                                                    \
      store(high, row + PF_LANES);                                                        \
    } else {                                                                              \
      type values[2 * PF_LANES];                                                          \
      PF_VSTORE(low, 0, values);                                                          \
      PF_VSTORE(high, 1, values);                                                         \
      for (uint i = sensels.first; i < sensels.end; ++i) row[i] = values[i];              \
    }                                                                                     \
  }
#endif
#define PF_AS_REAL(value) (value)
#define PF_STORE_BYTES(values, row) PF_STORE_WHOLE(uchar, values, row)
PF_DEFINE_STORE_SENSELS(sensel_plane, Real, float, PF_AS_REAL, PF_STORE_BLOCK)
PF_DEFINE_STORE_SENSELS(sensel_status, Bits, uchar, PF_JOIN(as_uchar, PF_LANES), PF_STORE_BYTES)
#endif

PF_INLINE void store_status(Bits value, global uchar* plane, Lanes lanes) {
#ifdef PF_SCALAR
  *plane = (uchar)value;
#else
  const PF_LANE_TYPE(uchar) bytes = PF_JOIN(as_uchar, PF_LANES)(value);
  if (are_all(lanes)) {
    PF_STORE_WHOLE(uchar, bytes, plane);
  } else {
    uchar values[PF_LANES];
    PF_VSTORE(bytes, 0, values);
    for (uint i = lanes.first; i < lanes.end; ++i) plane[i] = values[i];
  }
#endif
}

/* Status bytes of PF_LANES pillars from column `col` on; bytes outside the row are zero. */
PF_INLINE Bits load_status(global const uchar* row, int col, uint cols) {
#ifdef PF_SCALAR
  return col >= 0 && (uint)col < cols ? (Bits)row[col] : (Bits)0;
#else
  if (col >= 0 && (uint)col + PF_LANES <= cols) {
    return PF_JOIN(as_char, PF_LANES)(PF_LOAD_WHOLE(uchar, row + col));
  }
  uchar padded[PF_LANES];
  for (uint i = 0; i < PF_LANES; ++i) {
    const int at = col + (int)i;
    padded[i] = at >= 0 && (uint)at < cols ? row[at] : (uchar)0;
  }
  return PF_JOIN(as_char, PF_LANES)(PF_VLOAD(0, padded));
#endif
}
