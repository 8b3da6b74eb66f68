#include "contacts/contact_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "base/wide.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

/// Eight neighbouring pillars, one per lane. GNU vectors, since compilers vectorise the equivalent
/// loops poorly. Passed by reference: the calling convention of returns depends on the processor.
using Bytes [[gnu::vector_size(8)]] = std::uint8_t;
using Floats [[gnu::vector_size(32)]] = float;
using Ints [[gnu::vector_size(32)]] = std::int32_t;
using Doubles [[gnu::vector_size(32)]] = double;
using HalfFloats [[gnu::vector_size(16)]] = float;
constexpr std::uint32_t kLanes = 8;

/// Doubles of eight lanes: GCC handles no longer vectors well.
struct EightDoubles {
  Doubles low{};
  Doubles high{};
};

/// Status bits of a force that the pillar's own readings do not determine although three or four
/// sensels are usable.
constexpr int kUndetermined = status::kFromNeighbours | status::kSaturated | status::kInconsistent;

PF_WIDE_INLINE void select(const Floats& values, const Ints& mask, Floats& selected) {
  selected = __builtin_bit_cast(Floats, __builtin_bit_cast(Ints, values) & mask);
}

/// Loads eight forces; NaN, infinity and lanes not `present` become zero.
PF_WIDE_INLINE void read(const float* from, const Ints& present, Floats& values) {
  std::memcpy(&values, from, sizeof values);
  // NOLINTNEXTLINE(misc-redundant-expression): false for NaN
  select(values, (values - values == 0) & present, values);
}

PF_WIDE_INLINE void read(const std::uint8_t* from, const Ints& present, Ints& status) {
  Bytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  status = Ints{bytes[0], bytes[1], bytes[2], bytes[3], bytes[4], bytes[5], bytes[6], bytes[7]} &
           present;
}

PF_WIDE_INLINE void convert(const Floats& values, EightDoubles& doubles) {
  std::array<HalfFloats, 2> halves{};
  std::memcpy(halves.data(), &values, sizeof values);
  doubles.low = __builtin_convertvector(halves[0], Doubles);
  doubles.high = __builtin_convertvector(halves[1], Doubles);
}

PF_WIDE_INLINE void add(const EightDoubles& values, EightDoubles& sum) {
  sum.low += values.low;
  sum.high += values.high;
}

PF_WIDE_INLINE void add(const Floats& values, EightDoubles& sum) {
  EightDoubles doubles;
  convert(values, doubles);
  add(doubles, sum);
}

PF_WIDE_INLINE void add_product(const EightDoubles& values, const EightDoubles& factors,
                                EightDoubles& sum) {
  sum.low += values.low * factors.low;
  sum.high += values.high * factors.high;
}

PF_WIDE_INLINE void add_product(const EightDoubles& values, double factor, EightDoubles& sum) {
  sum.low += values.low * factor;
  sum.high += values.high * factor;
}

/// Addresses of eight pillars in each plane.
struct Place {
  const float* shear_x;
  const float* shear_y;
  const float* normal;
  const std::uint8_t* status;
};

/// A padded copy of the last, fewer than eight, pillars of a field.
struct LastPillars {
  std::array<float, std::size_t{3} * kLanes> forces{};
  std::array<std::uint8_t, kLanes> status{};

  Place copy(const ForceFieldView& field, std::size_t at) {
    if (!field.shear_x.empty()) {
      std::ranges::copy(field.shear_x.subspan(at), forces.begin());
      std::ranges::copy(field.shear_y.subspan(at), forces.begin() + kLanes);
    }
    std::ranges::copy(field.normal.subspan(at), forces.begin() + std::ptrdiff_t{2} * kLanes);
    std::ranges::copy(field.status.subspan(at), status.begin());
    return {forces.data(), forces.data() + kLanes, forces.data() + std::size_t{2} * kLanes,
            status.data()};
  }
};

double total_of(const EightDoubles& lanes) {
  const Doubles sums = lanes.low + lanes.high;
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

std::int64_t total_of(const Ints& lanes) {
  std::int64_t sum = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i) sum += lanes[i];
  return sum;
}

/// Normal forces by slip, of a run: as floats, since only their ratios are used.
struct SlipSums {
  Floats pressing{};
  Floats determined{};
  Floats slipping{};
  Floats reaching{};
  Floats sticking{};

  PF_WIDE_INLINE void add(const Floats& x, const Floats& y, const Floats& n, const Ints& status,
                          const SlipTest& test) {
    const Ints inactive = ~status & status::kUsable;
    const Ints known = ((inactive & (inactive - 1)) | (status & kUndetermined)) == 0;
    const Floats least = static_cast<float>(test.ratio) * n;
    const Floats surely = static_cast<float>(test.ratio) * (n - static_cast<float>(test.noise_n));
    const Floats square = x * x + y * y;
    Floats presses;
    Floats certain;
    Floats selected;
    select(n, n > 0, presses);
    select(presses, known, certain);
    pressing += presses;
    determined += certain;
    select(certain, square >= least * least, selected);
    slipping += selected;
    select(presses, square >= least * least, selected);
    reaching += selected;
    select(certain, (surely > 0) & (square < surely * surely), selected);
    sticking += selected;
  }
};

/// Partial sums: lane i holds every eighth pillar of a run, from the i-th.
struct Lanes {
  EightDoubles shear_x;
  EightDoubles shear_y;
  EightDoubles normal;
  EightDoubles normal_x;
  EightDoubles normal_y;
  EightDoubles shear_y_x;
  EightDoubles shear_x_y;
  EightDoubles pressing;
  EightDoubles determined;
  EightDoubles slipping;
  EightDoubles reaching;
  EightDoubles sticking;
  Ints ambiguous{};
  Ints resolved{};

  PF_WIDE_INLINE void add(const SlipSums& run) {
    pillarfield::add(run.pressing, pressing);
    pillarfield::add(run.determined, determined);
    pillarfield::add(run.slipping, slipping);
    pillarfield::add(run.reaching, reaching);
    pillarfield::add(run.sticking, sticking);
  }

  void add_to(ContactSum& sum) const {
    sum.shear_x = total_of(shear_x);
    sum.shear_y = total_of(shear_y);
    sum.normal = total_of(normal);
    sum.normal_x = total_of(normal_x);
    sum.normal_y = total_of(normal_y);
    sum.shear_y_x = total_of(shear_y_x);
    sum.shear_x_y = total_of(shear_x_y);
    sum.pressing = total_of(pressing);
    sum.determined = total_of(determined);
    sum.slipping = total_of(slipping);
    sum.reaching = total_of(reaching);
    sum.sticking = total_of(sticking);
    sum.ambiguous = total_of(ambiguous);
    sum.resolved = total_of(resolved);
  }
};

/// Prefetches the run four ahead in one plane; at the first run, all runs up to that one. Rows lie
/// too far apart for hardware prefetching.
template <class Value>
PF_WIDE_INLINE void prefetch(std::span<const Value> plane, const ForceFieldView& forces,
                             std::span<const ContactRun> runs, std::size_t run) {
  if (plane.empty()) return;
  constexpr std::size_t kAhead = 4;
  constexpr std::uint32_t kLine = 64 / sizeof(Value);
  const std::size_t end = std::min(run + kAhead + 1, runs.size());
  for (std::size_t at = run == 0 ? 0 : run + kAhead; at < end; ++at) {
    const ContactRun& ahead = runs[at];
    const Value* const row = plane.data() + std::size_t{ahead.row} * forces.cols;
    for (std::uint32_t col = ahead.first; col < ahead.end + kLine; col += kLine) {
      __builtin_prefetch(row + std::min(col, ahead.end - 1));
    }
  }
}

std::int64_t place_x(const ForceFieldView& forces, std::uint32_t col) {
  return 2 * std::int64_t{col} + 1 - forces.cols;
}

/// Adds the pillars of a run at height `y`. Returns their largest normal force.
PF_WIDE_INLINE float add_run(const ForceFieldView& forces, const ContactRun& run, double y,
                             const std::optional<SlipTest>& test, Lanes& lanes) {
  constexpr float kNone = -std::numeric_limits<float>::infinity();
  Floats peaks = Floats{} + kNone;
  static constexpr std::array<float, kLanes> kNoShear{};
  constexpr Ints kPlaces = {0, 1, 2, 3, 4, 5, 6, 7};
  const bool has_shear = !forces.shear_x.empty();
  LastPillars last;
  SlipSums slip;
  EightDoubles sum_x;
  EightDoubles sum_y;
  EightDoubles sum_n;
  const auto first = static_cast<double>(place_x(forces, run.first));
  EightDoubles x = {first + Doubles{0, 2, 4, 6}, first + Doubles{8, 10, 12, 14}};
  for (std::uint32_t col = run.first; col < run.end; col += kLanes) {
    const std::size_t at = std::size_t{run.row} * forces.cols + col;
    const Ints present = kPlaces < static_cast<std::int32_t>(run.end - col);
    Place from = {kNoShear.data(), kNoShear.data(), forces.normal.data() + at,
                  forces.status.data() + at};
    if (has_shear)
      from = {forces.shear_x.data() + at, forces.shear_y.data() + at, from.normal, from.status};
    if (at + kLanes > forces.status.size()) from = last.copy(forces, at);
    Floats shear_x;
    Floats shear_y;
    Floats normal;
    Ints status;
    read(from.shear_x, present, shear_x);
    read(from.shear_y, present, shear_y);
    read(from.normal, present, normal);
    read(from.status, present, status);
    peaks = (present & (normal > peaks)) ? normal : peaks;
    EightDoubles doubles;
    convert(normal, doubles);
    add(doubles, sum_n);
    add_product(doubles, x, lanes.normal_x);
    convert(shear_y, doubles);
    add(doubles, sum_y);
    add_product(doubles, x, lanes.shear_y_x);
    add(shear_x, sum_x);
    x.low += 2 * kLanes;
    x.high += 2 * kLanes;
    // A true lane is -1.
    lanes.ambiguous -= (status & (status::kAmbiguous | status::kFromNeighbours)) != 0;
    lanes.resolved -= (status & status::kFromNeighbours) != 0;
    if (test) slip.add(shear_x, shear_y, normal, status, *test);
  }
  add(sum_x, lanes.shear_x);
  add(sum_y, lanes.shear_y);
  add(sum_n, lanes.normal);
  add_product(sum_n, y, lanes.normal_y);
  add_product(sum_x, y, lanes.shear_x_y);
  lanes.add(slip);
  float peak = kNone;
  for (std::uint32_t i = 0; i < kLanes; ++i) peak = std::max(peak, peaks[i]);
  return peak;
}

}  // namespace

PF_WIDE ContactSum sum_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                          const std::optional<SlipTest>& test) {
  ContactSum sum;
  Lanes lanes;
  ContactRun with_peak;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    prefetch(forces.shear_x, forces, runs, i);
    prefetch(forces.shear_y, forces, runs, i);
    prefetch(forces.normal, forces, runs, i);
    prefetch(forces.status, forces, runs, i);
    const ContactRun& run = runs[i];
    const std::int64_t y = std::int64_t{forces.rows} - 2 * std::int64_t{run.row} - 1;
    const std::int64_t pillars = run.end - run.first;
    const float largest = add_run(forces, run, static_cast<double>(y), test, lanes);
    sum.pillars += pillars;
    sum.x += pillars * (place_x(forces, run.first) + pillars - 1);
    sum.y += pillars * y;
    if (largest <= sum.peak) continue;
    sum.peak = largest;
    sum.peak_y = y;
    with_peak = run;
  }
  lanes.add_to(sum);
  for (std::uint32_t col = with_peak.end; col-- > with_peak.first;) {
    const float normal = forces.normal[std::size_t{with_peak.row} * forces.cols + col];
    if ((std::isfinite(normal) ? normal : 0) == sum.peak) sum.peak_x = place_x(forces, col);
  }
  return sum;
}

void ContactSum::add(const ContactSum& next) {
  shear_x += next.shear_x;
  shear_y += next.shear_y;
  normal += next.normal;
  normal_x += next.normal_x;
  normal_y += next.normal_y;
  shear_y_x += next.shear_y_x;
  shear_x_y += next.shear_x_y;
  x += next.x;
  y += next.y;
  pillars += next.pillars;
  ambiguous += next.ambiguous;
  resolved += next.resolved;
  pressing += next.pressing;
  determined += next.determined;
  slipping += next.slipping;
  reaching += next.reaching;
  sticking += next.sticking;
  if (next.peak <= peak) return;
  peak = next.peak;
  peak_x = next.peak_x;
  peak_y = next.peak_y;
}

}  // namespace pillarfield
