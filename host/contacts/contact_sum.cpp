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

/// Four neighbouring pillars, one per lane. GNU vectors, since compilers vectorise the equivalent
/// loops poorly. Passed by reference: the calling convention of returns depends on the processor.
using Bytes [[gnu::vector_size(4)]] = std::uint8_t;
using Floats [[gnu::vector_size(16)]] = float;
using Ints [[gnu::vector_size(16)]] = std::int32_t;
using Doubles [[gnu::vector_size(32)]] = double;
using Longs [[gnu::vector_size(32)]] = std::int64_t;
constexpr std::uint32_t kLanes = 4;

/// Status bits of a force that the pillar's own readings do not determine although three or four
/// sensels are usable.
constexpr int kUndetermined = status::kFromNeighbours | status::kSaturated | status::kInconsistent;

/// Loads four forces; NaN, infinity and lanes not `present` become zero.
PF_WIDE_INLINE void read(const float* from, const Ints& present, Floats& values, Doubles& forces) {
  std::memcpy(&values, from, sizeof values);
  const Ints finite = values - values == 0;  // NOLINT(misc-redundant-expression): false for NaN
  values = __builtin_bit_cast(Floats, __builtin_bit_cast(Ints, values) & finite & present);
  forces = Doubles{values[0], values[1], values[2], values[3]};
}

PF_WIDE_INLINE void read(const std::uint8_t* from, const Ints& present, Ints& status) {
  Bytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  status = Ints{bytes[0], bytes[1], bytes[2], bytes[3]} & present;
}

/// Addresses of four pillars in each plane.
struct Place {
  const float* shear_x;
  const float* shear_y;
  const float* normal;
  const std::uint8_t* status;
};

/// A padded copy of the last, fewer than four, pillars of a field.
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

PF_WIDE_INLINE void select(const Doubles& values, const Longs& mask, Doubles& selected) {
  selected = __builtin_bit_cast(Doubles, __builtin_bit_cast(Longs, values) & mask);
}

template <class Vector>
auto total_of(const Vector& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// Partial sums: lane i holds every fourth pillar of a run, from the i-th.
struct Lanes {
  Doubles shear_x{};
  Doubles shear_y{};
  Doubles normal{};
  Doubles normal_x{};
  Doubles normal_y{};
  Doubles shear_y_x{};
  Doubles shear_x_y{};
  Doubles pressing{};
  Doubles determined{};
  Doubles slipping{};
  Doubles reaching{};
  Doubles sticking{};
  Ints ambiguous{};
  Ints resolved{};

  PF_WIDE_INLINE void add_slip(const Doubles& x, const Doubles& y, const Doubles& n,
                               const Ints& status, const SlipTest& test) {
    const Ints inactive = ~status & status::kUsable;
    const Ints known = ((inactive & (inactive - 1)) | (status & kUndetermined)) == 0;
    const Doubles least = test.ratio * n;
    const Doubles surely = test.ratio * (n - test.noise_n);
    const Doubles square = x * x + y * y;
    Doubles presses;
    Doubles certain;
    Doubles slips;
    Doubles reaches;
    Doubles sticks;
    select(n, n > 0, presses);
    select(presses, Longs{known[0], known[1], known[2], known[3]}, certain);
    select(certain, square >= least * least, slips);
    select(presses, square >= least * least, reaches);
    select(certain, (surely > 0) & (square < surely * surely), sticks);
    pressing += presses;
    determined += certain;
    slipping += slips;
    reaching += reaches;
    sticking += sticks;
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
  Floats peaks = {kNone, kNone, kNone, kNone};
  static constexpr std::array<float, kLanes> kNoShear{};
  const bool has_shear = !forces.shear_x.empty();
  LastPillars last;
  Doubles sum_x{};
  Doubles sum_y{};
  Doubles sum_n{};
  Doubles x = static_cast<double>(place_x(forces, run.first)) + Doubles{0, 2, 4, 6};
  for (std::uint32_t col = run.first; col < run.end; col += kLanes, x += 2 * kLanes) {
    const std::size_t at = std::size_t{run.row} * forces.cols + col;
    const Ints present = Ints{0, 1, 2, 3} < static_cast<std::int32_t>(run.end - col);
    Place from = {kNoShear.data(), kNoShear.data(), forces.normal.data() + at,
                  forces.status.data() + at};
    if (has_shear)
      from = {forces.shear_x.data() + at, forces.shear_y.data() + at, from.normal, from.status};
    if (at + kLanes > forces.status.size()) from = last.copy(forces, at);
    Floats values;
    Doubles shear_x;
    Doubles shear_y;
    Doubles normal;
    Ints status;
    read(from.shear_x, present, values, shear_x);
    read(from.shear_y, present, values, shear_y);
    read(from.normal, present, values, normal);
    read(from.status, present, status);
    peaks = (present & (values > peaks)) ? values : peaks;
    sum_x += shear_x;
    sum_y += shear_y;
    sum_n += normal;
    lanes.normal_x += normal * x;
    lanes.shear_y_x += shear_y * x;
    // A true lane is -1.
    lanes.ambiguous -= (status & (status::kAmbiguous | status::kFromNeighbours)) != 0;
    lanes.resolved -= (status & status::kFromNeighbours) != 0;
    if (test) lanes.add_slip(shear_x, shear_y, normal, status, *test);
  }
  lanes.shear_x += sum_x;
  lanes.shear_y += sum_y;
  lanes.normal += sum_n;
  lanes.normal_y += sum_n * y;
  lanes.shear_x_y += sum_x * y;
  return std::max(std::max(peaks[0], peaks[1]), std::max(peaks[2], peaks[3]));
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
