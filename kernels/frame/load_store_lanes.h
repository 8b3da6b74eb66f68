/* load_store.h in C++ with vectors: loads and stores of PF_LANES pillars at once. */

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

typedef PF_LANES_OF(uchar) Bytes;
typedef PF_LANES_OF(ushort) BytePairs;
typedef PF_LANES_OF(int) Places;
#define PF_LANES_OF_float Real
#define PF_LANES_OF_uchar Bytes
#define PF_LANE_TYPE_(type) PF_LANES_OF_##type
#define PF_LANE_TYPE(type) PF_LANE_TYPE_(type)

/* Unaligned vectors. */
template <class Vector>
PF_INLINE Vector load_whole(const void* place) {
  Vector lanes;
  __builtin_memcpy(&lanes, place, sizeof(lanes));
  return lanes;
}
template <class Vector>
PF_INLINE void store_whole(Vector lanes, void* place) {
  __builtin_memcpy(place, &lanes, sizeof(lanes));
}
#define PF_LOAD_WHOLE(type, place) load_whole<PF_LANE_TYPE(type)>(place)
#define PF_STORE_WHOLE(type, lanes, place) store_whole<PF_LANE_TYPE(type)>(lanes, place)
#define PF_VLOAD(at, place) load_whole<Real>((place) + (at)*PF_LANES)
#define PF_VSTORE(lanes, at, place) store_whole(lanes, (place) + (at)*PF_LANES)
#define PF_ANY(mask) any_bits(mask)

template <int... i>
PF_INLINE Real numbers_of(std::integer_sequence<int, i...>) {
  return Real{static_cast<float>(i)...};
}
using LaneSequence = std::make_integer_sequence<int, PF_LANES>;
#define PF_LANE_NUMBERS numbers_of(LaneSequence())

template <class Vector>
PF_INLINE Real real_lanes(Vector lanes) {
  return __builtin_convertvector(lanes, Real);
}
#define PF_TO_REAL real_lanes

#ifdef __clang__
#define PF_SHUFFLE(low, high, ...) __builtin_shufflevector(low, high, __VA_ARGS__)
#else
#define PF_SHUFFLE(low, high, ...) __builtin_shuffle(low, high, Places{__VA_ARGS__})
#endif
/* Left and right sensels alternate in memory. */
template <int... i>
PF_INLINE RealPair split_lanes(Real low, Real high, std::integer_sequence<int, i...>) {
  return {PF_SHUFFLE(low, high, 2 * i...), PF_SHUFFLE(low, high, (2 * i + 1)...)};
}
template <int... i>
PF_INLINE RealPair alternate_lanes(Real left, Real right, std::integer_sequence<int, i...>) {
  return {PF_SHUFFLE(left, right, (i / 2 + i % 2 * PF_LANES)...),
          PF_SHUFFLE(left, right, ((i + PF_LANES) / 2 + (i + PF_LANES) % 2 * PF_LANES)...)};
}
#undef PF_SHUFFLE

PF_INLINE RealPair load_plane(const float* row) {
  return split_lanes(PF_VLOAD(0, row), PF_VLOAD(1, row), LaneSequence());
}
PF_INLINE RealPair load_private(const float* row) { return load_plane(row); }
#ifdef PF_WHOLE
/* Both readings of a pillar form one integer. */
PF_INLINE CountsPair load_readings(const uchar* row) {
  const BytePairs both = load_whole<BytePairs>(row);
  return {(Counts)(both & 0xff) * (short)PF_WHOLE, (Counts)(both >> 8) * (short)PF_WHOLE};
}
#else
PF_INLINE CountsPair load_readings(const float* row) { return load_plane(row); }
#endif
PF_INLINE RealPair load_mask(const uchar* row) {
  const Word both = __builtin_convertvector(load_whole<BytePairs>(row), Word);
  return {PF_TO_REAL((Places)(both & PF_WORD(0xff))), PF_TO_REAL((Places)(both >> PF_WORD(8)))};
}

#define PF_PREFETCH_SPAN(row, count, locality)                             \
  for (size_t byte_ = 0; byte_ < (count) * sizeof(*(row)); byte_ += 64) {  \
    __builtin_prefetch((const void*)((size_t)(row) + byte_), 0, locality); \
  }
#define PF_PREFETCH(row) PF_PREFETCH_SPAN(row, 2 * PF_LANES, 3)
#define PF_PREFETCH_FAR(row) PF_PREFETCH_SPAN(row, 2 * PF_LANES, 2)

/* Range of the lanes of a block that are written. */
typedef struct {
  uint first;
  uint end;
} Lanes;

PF_INLINE bool are_all(Lanes lanes) { return lanes.end - lanes.first == PF_LANES; }

/* Writes those of `lanes`. */
template <class Vector, class Value>
PF_INLINE void store_some(Vector vector, Value* place, Lanes lanes) {
  if (are_all(lanes)) return store_whole(vector, place);
  Value values[PF_LANES];
  store_whole(vector, values);
  for (uint i = lanes.first; i < lanes.end; ++i) place[i] = values[i];
}
PF_INLINE void store_plane(Real value, float* plane, Lanes lanes) {
  store_some(value, plane, lanes);
}
PF_INLINE void store_status(Bits value, uchar* plane, Lanes lanes) {
  store_some(__builtin_convertvector(value, Bytes), plane, lanes);
}
/* Writes values of one row of sensels, those of `sensels`, in the layout that load_plane reads. */
PF_INLINE void store_sensel_plane(Real left, Real right, float* row, Lanes sensels) {
  const RealPair both = alternate_lanes(left, right, LaneSequence());
  if (sensels.end - sensels.first == 2 * PF_LANES) {
    store_whole(both.left, row);
    store_whole(both.right, row + PF_LANES);
    return;
  }
  float values[2 * PF_LANES];
  store_whole(both.left, values);
  store_whole(both.right, values + PF_LANES);
  for (uint i = sensels.first; i < sensels.end; ++i) row[i] = values[i];
}
PF_INLINE void store_pair(RealPair pair, float* row, Lanes lanes) {
  const Lanes sensels = {2 * lanes.first, 2 * lanes.end};
  store_sensel_plane(pair.left, pair.right, row, sensels);
}
PF_INLINE void store_readings(RealPair pair, float* row, Lanes lanes) {
  store_pair(pair, row, lanes);
}
PF_INLINE void store_sensel_status(Bits left, Bits right, uchar* row, Lanes sensels) {
  ushort values[PF_LANES];
  store_whole(
      __builtin_convertvector(left, BytePairs) | (__builtin_convertvector(right, BytePairs) << 8),
      values);
  uchar bytes[2 * PF_LANES];
  __builtin_memcpy(bytes, values, sizeof(bytes));
  for (uint i = sensels.first; i < sensels.end; ++i) row[i] = bytes[i];
}

/* Status bytes of PF_LANES pillars from column `col` on; bytes outside the row are zero. */
PF_INLINE Bits load_status(const uchar* row, int col, uint cols) {
  if (col >= 0 && (uint)col + PF_LANES <= cols) {
    return __builtin_convertvector(load_whole<Bytes>(row + col), Bits);
  }
  uchar padded[PF_LANES];
  for (uint i = 0; i < PF_LANES; ++i) {
    const int at = col + (int)i;
    padded[i] = at >= 0 && (uint)at < cols ? row[at] : (uchar)0;
  }
  return __builtin_convertvector(load_whole<Bytes>(padded), Bits);
}

/* Maximum and minimum of numbers and of vectors. */
template <class Value>
PF_INLINE Value max(Value a, Value b) {
  return a < b ? b : a;
}
template <class Value>
PF_INLINE Value min(Value a, Value b) {
  return b < a ? b : a;
}
