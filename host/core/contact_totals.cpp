#include "core/contact_totals.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "core/contact_block.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

/// So many blocks are summed before they are added to the totals: moments stay below 2^53 and so
/// exact in double precision, counts in bytes below 2^8.
constexpr std::uint32_t kMostBlocks = 64;

/// One sum for each pillar of a block: no sum needs its neighbour's before the very end.
using LaneSums = std::array<double, kBlock>;

PF_INLINE std::int64_t total_of(const LaneSums& sums) {
  std::int64_t total = 0;
  for (const double sum : sums) total += static_cast<std::int64_t>(sum);
  return total;
}

/// The same, each times twice its place in the block.
PF_INLINE std::int64_t moment_of(const LaneSums& sums) {
  std::int64_t total = 0;
  for (std::size_t i = 0; i < kBlock; ++i) {
    total += 2 * static_cast<std::int64_t>(i) * static_cast<std::int64_t>(sums[i]);
  }
  return total;
}

/// Forces, and their products with the place of their block, which is that of its first pillar.
struct ForceLanes {
  LaneSums shear_x{};
  LaneSums shear_y{};
  LaneSums normal{};
  LaneSums normal_x{};
  LaneSums normal_y{};
  LaneSums shear_y_x{};
  LaneSums shear_x_y{};

  PF_INLINE void add(const BlockQuanta& quanta_x, const BlockQuanta& quanta_y,
                     const BlockQuanta& quanta_n, double x, double y) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double along_x = quanta_x[i];
      const double along_y = quanta_y[i];
      const double pressed = quanta_n[i];
      shear_x[i] += along_x;
      shear_x_y[i] += along_x * y;
      shear_y[i] += along_y;
      shear_y_x[i] += along_y * x;
      normal[i] += pressed;
      normal_x[i] += pressed * x;
      normal_y[i] += pressed * y;
    }
  }
};

/// Bytes of a word that have one of the bits 4 and 7, or bit 7, counted byte by byte.
struct StatusCounts {
  static constexpr std::uint64_t kEachByte = 0x0101010101010101u;
  std::uint64_t ambiguous = 0;
  std::uint64_t resolved = 0;

  PF_INLINE void add(const std::uint8_t* status, const std::uint8_t* mask) {
    static_assert(status::kAmbiguous == 1 << 4 && status::kFromNeighbours == 1 << 7);
    for (std::size_t word = 0; word < kBlock; word += kWord) {
      std::uint64_t bits = 0;
      std::uint64_t wanted = 0;
      std::memcpy(&bits, status + word, kWord);
      std::memcpy(&wanted, mask + word, kWord);
      bits &= wanted;
      ambiguous += ((bits >> 7) | (bits >> 4)) & kEachByte;
      resolved += (bits >> 7) & kEachByte;
    }
  }

  static std::int64_t total(std::uint64_t counts) {
    constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
    const std::uint64_t pairs = (counts & kEven) + ((counts >> 8) & kEven);
    return static_cast<std::int64_t>((pairs * 0x0001000100010001u) >> 48);
  }
};

/// What PressingSum sums.
struct SlipLanes {
  LaneSums pressing{};
  LaneSums known{};
  LaneSums slipping{};

  PF_INLINE void add(const BlockQuanta& shear_x, const BlockQuanta& shear_y,
                     const BlockQuanta& normal, const std::uint8_t* status, float least_ratio) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto x = static_cast<float>(shear_x[i]);
      const auto y = static_cast<float>(shear_y[i]);
      const float least = least_ratio * static_cast<float>(normal[i]);
      const std::int32_t presses = std::max(normal[i], 0);
      const std::int32_t is_told = is_known(status[i]) ? presses : 0;
      const std::int32_t slips = x * x + y * y >= least * least ? is_told : 0;
      pressing[i] += presses;
      known[i] += is_told;
      slipping[i] += slips;
    }
  }
};

/// The same of one pillar.
void add_slip(const PillarForce& pillar, float least_ratio, PressingSum& slip) {
  if (pillar.normal <= 0) return;
  slip.pressing += pillar.normal;
  if (!is_known(pillar.status)) return;
  slip.known += pillar.normal;
  const auto x = static_cast<float>(pillar.shear_x);
  const auto y = static_cast<float>(pillar.shear_y);
  const float least = least_ratio * static_cast<float>(pillar.normal);
  if (x * x + y * y >= least * least) slip.slipping += pillar.normal;
}

PF_INLINE BlockQuanta larger_of(const BlockQuanta& a, const BlockQuanta& b) {
  BlockQuanta larger;
  for (std::size_t i = 0; i < kBlock; ++i) larger[i] = std::max(a[i], b[i]);
  return larger;
}

PF_INLINE std::int32_t largest_of(const BlockQuanta& quanta) {
  std::int32_t largest = quanta[0];
  for (std::size_t i = 0; i < kBlock; ++i) largest = std::max(largest, quanta[i]);
  return largest;
}

/// Blocks, summed.
struct BlockSums {
  ForceLanes forces;
  StatusCounts counts;
  SlipLanes slip;
  std::uint32_t blocks = 0;
};

/// Adds blocks to totals, all but the peak and what needs no force, and begins anew.
void empty_into(ContactTotals& totals, BlockSums& sums) {
  const ForceLanes& forces = sums.forces;
  ContactSum& sum = totals.sum;
  sum.shear_x += total_of(forces.shear_x);
  sum.shear_y += total_of(forces.shear_y);
  sum.normal += total_of(forces.normal);
  sum.normal_x.add_product(total_of(forces.normal_x) + moment_of(forces.normal));
  sum.normal_y.add_product(total_of(forces.normal_y));
  sum.shear_y_x.add_product(total_of(forces.shear_y_x) + moment_of(forces.shear_y));
  sum.shear_x_y.add_product(total_of(forces.shear_x_y));
  sum.ambiguous += StatusCounts::total(sums.counts.ambiguous);
  sum.resolved += StatusCounts::total(sums.counts.resolved);
  const SlipLanes& slip = sums.slip;
  totals.slip.add({total_of(slip.pressing), total_of(slip.known), total_of(slip.slipping)});
  sums = {};
}

/// Asks for what the next runs need of a plane: rows are too far apart for a processor to guess.
template <class Value>
PF_INLINE void ask_for(std::span<const Value> plane, const ForceFieldView& forces,
                       std::span<const ContactRun> runs, std::size_t run) {
#if defined(__GNUC__)
  constexpr std::size_t kAhead = 4;
  constexpr std::uint32_t kLine = 64 / sizeof(Value);
  if (run + kAhead >= runs.size()) return;
  const ContactRun& ahead = runs[run + kAhead];
  const Value* const row = plane.data() + std::size_t{ahead.row} * forces.cols;
  for (std::uint32_t col = ahead.first; col < ahead.end + kLine; col += kLine) {
    __builtin_prefetch(row + std::min(col, ahead.end - 1));
  }
#endif
}

PF_INLINE void ask_for_all(const ForceFieldView& forces, std::span<const ContactRun> runs,
                           std::size_t run) {
  ask_for(forces.shear_x, forces, runs, run);
  ask_for(forces.shear_y, forces, runs, run);
  ask_for(forces.normal, forces, runs, run);
  ask_for(forces.status, forces, runs, run);
}

/// Raises each peak to the normal force beside it, where that is above it and no NaN.
PF_INLINE std::array<float, kBlock> raised(const std::array<float, kBlock>& peaks,
                                           const float* normal) {
  std::array<float, kBlock> higher{};
  for (std::size_t i = 0; i < kBlock; ++i) higher[i] = normal[i] > peaks[i] ? normal[i] : peaks[i];
  return higher;
}

/// Finds which pillar of a run has the peak, if any has.
void add_peak(const ForceFieldView& forces, const ForceQuanta& quanta, const ContactRun& run,
              ContactSum& sum) {
  for (std::uint32_t col = run.first; col < run.end; ++col) {
    const PillarForce pillar = pillar_at(forces, quanta, run.row, col);
    sum.add_peak(pillar.normal, pillar.x, pillar.y);
  }
}

/// How runs are summed.
struct Summing {
  const ForceFieldView& forces;
  ForceQuanta quanta;
  bool with_slip;
  float least_ratio;
};

/// Adds pillars of a row one by one.
void add_pillars(const Summing& summing, std::uint32_t row, std::uint32_t first, std::uint32_t end,
                 ContactTotals& totals) {
  for (std::uint32_t col = first; col < end; ++col) {
    const PillarForce pillar = pillar_at(summing.forces, summing.quanta, row, col);
    totals.sum.add(pillar);
    if (summing.with_slip) add_slip(pillar, summing.least_ratio, totals.slip);
  }
}

/// Adds a run, in blocks wherever its forces make such; returns the blocks' largest normal force.
PF_INLINE std::int32_t add_run(const Summing& summing, const ContactRun& run, BlockSums& sums,
                               ContactTotals& totals) {
  const ForceFieldView& forces = summing.forces;
  const auto y = static_cast<double>(place_y(forces, run.row));
  BlockQuanta peaks{};
  for (std::uint32_t first = run.first; first < run.end; first += kBlock) {
    const std::uint32_t pillars = std::min(kBlock, run.end - first);
    const std::size_t at = std::size_t{run.row} * forces.cols + first;
    if (!makes_block(forces, at)) {
      add_pillars(summing, run.row, first, first + pillars, totals);
      continue;
    }
    const std::size_t past = kBlock - pillars;
    const std::int32_t* const mask = kMasks<std::int32_t>.data() + past;
    const std::uint8_t* const status = forces.status.data() + at;
    const BlockQuanta shear_x = quantised(forces.shear_x.data() + at, mask);
    const BlockQuanta shear_y = quantised(forces.shear_y.data() + at, mask);
    const BlockQuanta normal = quantised(forces.normal.data() + at, mask);
    const std::int64_t x = place_x(forces, first);
    sums.forces.add(shear_x, shear_y, normal, static_cast<double>(x), y);
    sums.counts.add(status, kMasks<std::uint8_t>.data() + past);
    if (summing.with_slip) {
      sums.slip.add(shear_x, shear_y, normal, status, summing.least_ratio);
    }
    peaks = larger_of(peaks, normal);
    totals.sum.x += pillars * (x + pillars - 1);
    totals.sum.y += pillars * place_y(forces, run.row);
    totals.sum.pillars += pillars;
    if (++sums.blocks == kMostBlocks) empty_into(totals, sums);
  }
  return largest_of(peaks);
}

}  // namespace

PF_WIDE ContactTotals totals_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                                std::optional<double> least_ratio) {
  const Summing summing = {forces, ForceQuanta(forces.normal.size()), least_ratio.has_value(),
                           static_cast<float>(least_ratio.value_or(0))};
  ContactTotals totals;
  BlockSums sums;
  std::int32_t peak = 0;
  ContactRun with_peak;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ask_for_all(forces, runs, i);
    const std::int32_t largest = add_run(summing, runs[i], sums, totals);
    // What is masked has no force: less than none is not seen, but it is also rare.
    if (largest == 0) add_peak(forces, summing.quanta, runs[i], totals.sum);
    if (largest <= peak) continue;
    peak = largest;
    with_peak = runs[i];
  }
  empty_into(totals, sums);
  add_peak(forces, summing.quanta, with_peak, totals.sum);
  return totals;
}

PF_WIDE float peak_of(const ForceFieldView& forces, std::span<const ContactRun> runs) {
  std::array<float, kBlock> peaks{};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ContactRun& run = runs[i];
    ask_for(forces.normal, forces, runs, i);
    const float* const normal = forces.normal.data() + std::size_t{run.row} * forces.cols;
    std::uint32_t col = run.first;
    for (; col + kBlock <= run.end; col += kBlock) peaks = raised(peaks, normal + col);
    for (; col < run.end; ++col) peaks[0] = normal[col] > peaks[0] ? normal[col] : peaks[0];
  }
  return *std::max_element(peaks.begin(), peaks.end());
}

}  // namespace pillarfield
