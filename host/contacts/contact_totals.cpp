#include "contacts/contact_totals.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "contacts/contact_block.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"

namespace pillarfield {
namespace {

/// So many blocks are summed before they are added to the totals: moments stay below 2^53 and so
/// exact in double precision, counts in bytes below 2^8.
constexpr std::uint32_t kMostBlocks = 127;

/// A quantity of a block's pillars, in two halves.
struct BlockWholes {
  Wholes first;
  Wholes last;
};

struct BlockFloats {
  Floats first;
  Floats last;
};

/// Every fourth pillar of a block.
PF_INLINE void quarters_of(const Wholes& half, FourWholes& lower, FourWholes& upper) {
  lower = __builtin_shufflevector(half, half, 0, 1, 2, 3);
  upper = __builtin_shufflevector(half, half, 4, 5, 6, 7);
}

std::int64_t total_of(const FourDoubles& sums) {
  std::int64_t total = 0;
  for (int lane = 0; lane < 4; ++lane) total += static_cast<std::int64_t>(sums[lane]);
  return total;
}

/// Which products with a block's place are wanted.
enum class Moments : std::uint8_t { by_x, by_y, both };

/// A force summed over blocks, a lane for every fourth pillar, and its products with the block's
/// place, which is that of its first pillar. No sum needs its neighbour's before the very end.
template <Moments moments>
struct ForceLanes {
  FourDoubles force{};
  FourDoubles within{};  ///< each times the quarter of the block that it is in
  FourDoubles by_x{};
  FourDoubles by_y{};

  PF_INLINE void add(const BlockWholes& quanta, double x, double y) {
    FourWholes zeroth;
    FourWholes first;
    FourWholes second;
    FourWholes third;
    quarters_of(quanta.first, zeroth, first);
    quarters_of(quanta.last, second, third);
    const FourWholes odd = first + third;
    const FourDoubles sum = __builtin_convertvector(zeroth + second + odd, FourDoubles);
    force += sum;
    if constexpr (moments != Moments::by_x) by_y += sum * y;
    if constexpr (moments == Moments::by_y) return;
    const FourWholes upper = second + third;
    by_x += sum * x;
    within += __builtin_convertvector(odd + upper + upper, FourDoubles);
  }

  [[nodiscard]] std::int64_t moment_x() const {
    std::int64_t moment = total_of(by_x) + 8 * total_of(within);
    for (int lane = 1; lane < 4; ++lane) {
      moment += std::int64_t{2} * lane * static_cast<std::int64_t>(force[lane]);
    }
    return moment;
  }
};

/// Bytes of a word that have one of the bits 4 and 7, or bit 7, counted byte by byte.
struct StatusCounts {
  static constexpr std::uint64_t kEachByte = 0x0101010101010101u;
  std::uint64_t ambiguous = 0;
  std::uint64_t resolved = 0;

  PF_INLINE void add(const std::uint8_t* status, const std::uint8_t* mask) {
    static_assert(status::kAmbiguous == 1 << 4 && status::kFromNeighbours == 1 << 7);
    for (std::size_t word = 0; word < kBlock; word += kWordBytes) {
      std::uint64_t bits = 0;
      std::uint64_t wanted = 0;
      std::memcpy(&bits, status + word, kWordBytes);
      std::memcpy(&wanted, mask + word, kWordBytes);
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

/// Adds what presses, quanta none of which is below zero, four pillars to a lane.
PF_INLINE void add_quarters(const BlockWholes& pressing, FourDoubles& sum) {
  const Wholes both = pressing.first + pressing.last;
  FourWholes first;
  FourWholes last;
  quarters_of(both, first, last);
  sum += __builtin_convertvector(first + last, FourDoubles);
}

/// Which of a block's pillars are in region 1 or 2 with nothing wrong: is_known() of each.
PF_INLINE void known_of(const std::uint8_t* status, BlockWholes& known) {
  using Bytes [[gnu::vector_size(kBlock)]] = std::uint8_t;
  Bytes bits;
  load(status, bits);
  const Bytes lifted = ~bits & status::kUsable;
  const auto told = ((lifted & (lifted - 1)) | (bits & kDoubtful)) == 0;
  known.first =
      __builtin_convertvector(__builtin_shufflevector(told, told, 0, 1, 2, 3, 4, 5, 6, 7), Wholes);
  known.last = __builtin_convertvector(
      __builtin_shufflevector(told, told, 8, 9, 10, 11, 12, 13, 14, 15), Wholes);
}

PF_INLINE void slipping_of(const Wholes& shear_x, const Wholes& shear_y, const Wholes& normal,
                           float least_ratio, Wholes& slipping) {
  const Floats x = __builtin_convertvector(shear_x, Floats);
  const Floats y = __builtin_convertvector(shear_y, Floats);
  const Floats least = least_ratio * __builtin_convertvector(normal, Floats);
  slipping = x * x + y * y >= least * least;
}

/// What PressingSum sums.
struct SlipLanes {
  FourDoubles pressing{};
  FourDoubles known{};
  FourDoubles slipping{};

  PF_INLINE void add(const BlockWholes& shear_x, const BlockWholes& shear_y,
                     const BlockWholes& normal, const std::uint8_t* status, float least_ratio) {
    const BlockWholes presses = {normal.first > 0 ? normal.first : Wholes{},
                                 normal.last > 0 ? normal.last : Wholes{}};
    BlockWholes told{};
    known_of(status, told);
    told = {told.first & presses.first, told.last & presses.last};
    BlockWholes slips{};
    slipping_of(shear_x.first, shear_y.first, normal.first, least_ratio, slips.first);
    slipping_of(shear_x.last, shear_y.last, normal.last, least_ratio, slips.last);
    add_quarters(presses, pressing);
    add_quarters(told, known);
    add_quarters({told.first & slips.first, told.last & slips.last}, slipping);
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

/// Blocks, summed.
struct BlockSums {
  SlipLanes slip;
  ForceLanes<Moments::by_y> shear_x;
  ForceLanes<Moments::by_x> shear_y;
  ForceLanes<Moments::both> normal;
  StatusCounts counts;
  std::uint32_t blocks = 0;
};

/// Adds blocks to totals, all but the peak and what needs no force, and begins anew.
void empty_into(ContactTotals& totals, BlockSums& sums) {
  ContactSum& sum = totals.sum;
  sum.shear_x += total_of(sums.shear_x.force);
  sum.shear_y += total_of(sums.shear_y.force);
  sum.normal += total_of(sums.normal.force);
  sum.normal_x.add_product(sums.normal.moment_x());
  sum.normal_y.add_product(total_of(sums.normal.by_y));
  sum.shear_y_x.add_product(sums.shear_y.moment_x());
  sum.shear_x_y.add_product(total_of(sums.shear_x.by_y));
  sum.ambiguous += StatusCounts::total(sums.counts.ambiguous);
  sum.resolved += StatusCounts::total(sums.counts.resolved);
  totals.slip.add(
      {total_of(sums.slip.pressing), total_of(sums.slip.known), total_of(sums.slip.slipping)});
  sums = {};
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
  ForceQuanta quanta{1};
  bool with_slip = false;
  float least_ratio = 0;
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

/// Whether a mask has lost lanes.
PF_INLINE bool differ(const BlockWholes& a, const BlockWholes& b) {
  using Words [[gnu::vector_size(32)]] = std::uint64_t;
  const Wholes differences = (a.first ^ b.first) | (a.last ^ b.last);
  const auto words = __builtin_bit_cast(Words, differences);
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// Reads a plane's block, and takes lanes out of a mask as keep_small() does.
PF_INLINE void read_plane(const float* plane, BlockFloats& force_n, BlockWholes& mask) {
  load(plane, force_n.first);
  load(plane + kLanes, force_n.last);
  keep_small(force_n.first, mask.first);
  keep_small(force_n.last, mask.last);
}

PF_INLINE void quantise_both(const BlockFloats& force_n, const BlockWholes& mask,
                             BlockWholes& quanta) {
  quantise(force_n.first, mask.first, quanta.first);
  quantise(force_n.last, mask.last, quanta.last);
}

/// The forces of a block in quanta, zero past its last pillar.
struct Block {
  BlockWholes shear_x;
  BlockWholes shear_y;
  BlockWholes normal;

  /// False where a force is too large for that, or the planes end.
  PF_INLINE bool read(const ForceFieldView& forces, std::size_t at, std::uint32_t pillars) {
    if (at + kBlock > forces.normal.size()) return false;
    BlockWholes mask{};
    load(kMasks<std::int32_t>.data() + kBlock - pillars, mask.first);
    load(kMasks<std::int32_t>.data() + kBlock - pillars + kLanes, mask.last);
    BlockWholes small = mask;
    BlockFloats x_n{};
    BlockFloats y_n{};
    BlockFloats normal_n{};
    read_plane(forces.shear_x.data() + at, x_n, small);
    read_plane(forces.shear_y.data() + at, y_n, small);
    read_plane(forces.normal.data() + at, normal_n, small);
    if (differ(small, mask)) return false;
    quantise_both(x_n, mask, shear_x);
    quantise_both(y_n, mask, shear_y);
    quantise_both(normal_n, mask, normal);
    return true;
  }
};

/// Adds the block at (row, col).
PF_INLINE void add_block(const Summing& summing, const Block& block, std::uint32_t row,
                         std::uint32_t col, std::uint32_t pillars, BlockSums& sums) {
  const ForceFieldView& forces = summing.forces;
  const auto x = static_cast<double>(place_x(forces, col));
  const auto y = static_cast<double>(place_y(forces, row));
  sums.shear_x.add(block.shear_x, x, y);
  sums.shear_y.add(block.shear_y, x, y);
  sums.normal.add(block.normal, x, y);
  const std::uint8_t* const status = forces.status.data() + std::size_t{row} * forces.cols + col;
  sums.counts.add(status, kMasks<std::uint8_t>.data() + kBlock - pillars);
  if (summing.with_slip) {
    sums.slip.add(block.shear_x, block.shear_y, block.normal, status, summing.least_ratio);
  }
}

PF_INLINE void raise(Wholes& peaks, const Wholes& to) { peaks = to > peaks ? to : peaks; }

/// Adds a run, in blocks wherever its forces make such; returns the blocks' largest normal force.
PF_INLINE std::int32_t add_run(const Summing& summing, const ContactRun& run, BlockSums& sums,
                               ContactTotals& totals) {
  const ForceFieldView& forces = summing.forces;
  Wholes peaks{};
  for (std::uint32_t first = run.first; first < run.end; first += kBlock) {
    const std::uint32_t pillars = std::min(kBlock, run.end - first);
    Block block{};
    if (!block.read(forces, std::size_t{run.row} * forces.cols + first, pillars)) {
      add_pillars(summing, run.row, first, first + pillars, totals);
      continue;
    }
    add_block(summing, block, run.row, first, pillars, sums);
    raise(peaks, block.normal.first);
    raise(peaks, block.normal.last);
    totals.sum.x += pillars * (place_x(forces, first) + pillars - 1);
    totals.sum.y += pillars * place_y(forces, run.row);
    totals.sum.pillars += pillars;
    if (++sums.blocks == kMostBlocks) empty_into(totals, sums);
  }
  std::int32_t largest = 0;
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) largest = std::max(largest, peaks[lane]);
  return largest;
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
