#include "core/contact_totals.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "core/contact_block.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLanes = 4;
constexpr std::size_t kWord = sizeof(std::uint64_t);

/// Runs are taken in pieces of so many, 64 blocks: sums of moments stay below 2^53 and so exact in
/// double precision, counts of blocks below 2^8.
constexpr std::uint32_t kPiece = 1024;

using LaneSums = std::array<double, kLanes>;

/// Adds four pillars to each lane.
PF_INLINE LaneSums plus(const LaneSums& sums, const BlockQuanta& quanta) {
  LaneSums more;
  for (std::size_t i = 0; i < kLanes; ++i) {
    more[i] = sums[i] + ((double{1} * quanta[i] + quanta[i + 4]) +
                         (double{1} * quanta[i + 8] + quanta[i + 12]));
  }
  return more;
}

PF_INLINE std::int64_t value_of(const LaneSums& sums) {
  return static_cast<std::int64_t>((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

/// A force summed over pillars side by side, and its moment about the first of them, in pitches.
struct MomentLanes {
  LaneSums force{};
  LaneSums moment{};

  PF_INLINE void add(const BlockQuanta& quanta, double place) {
    force = plus(force, quanta);
    LaneSums more;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double at = place + static_cast<double>(static_cast<int>(i));
      more[i] = moment[i] + ((quanta[i] * at + quanta[i + 4] * (at + 4)) +
                             (quanta[i + 8] * (at + 8) + quanta[i + 12] * (at + 12)));
    }
    moment = more;
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
    BlockQuanta presses;
    BlockQuanta is_told;
    BlockQuanta slips;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto x = static_cast<float>(shear_x[i]);
      const auto y = static_cast<float>(shear_y[i]);
      const float least = least_ratio * static_cast<float>(normal[i]);
      presses[i] = std::max(normal[i], 0);
      is_told[i] = is_known(status[i]) ? presses[i] : 0;
      slips[i] = x * x + y * y >= least * least ? is_told[i] : 0;
    }
    pressing = plus(pressing, presses);
    known = plus(known, is_told);
    slipping = plus(slipping, slips);
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

/// A piece of a run, summed.
struct PieceSum {
  LaneSums shear_x{};
  MomentLanes shear_y;
  MomentLanes normal;
  BlockQuanta peaks{};
  StatusCounts counts;
  SlipLanes slip;
};

PF_INLINE PieceSum sum_piece(const ForceFieldView& forces, std::size_t begin, std::uint32_t pillars,
                             bool with_slip, float least_ratio) {
  PieceSum sum;
  for (std::uint32_t first = 0; first < pillars; first += kBlock) {
    const std::size_t past = kBlock - std::min(kBlock, pillars - first);
    const std::int32_t* const mask = kMasks<std::int32_t>.data() + past;
    const std::size_t at = begin + first;
    const std::uint8_t* const status = forces.status.data() + at;
    const BlockQuanta shear_x = quantised(forces.shear_x.data() + at, mask);
    const BlockQuanta shear_y = quantised(forces.shear_y.data() + at, mask);
    const BlockQuanta normal = quantised(forces.normal.data() + at, mask);
    sum.shear_x = plus(sum.shear_x, shear_x);
    sum.shear_y.add(shear_y, first);
    sum.normal.add(normal, first);
    sum.peaks = larger_of(sum.peaks, normal);
    sum.counts.add(status, kMasks<std::uint8_t>.data() + past);
    if (with_slip) sum.slip.add(shear_x, shear_y, normal, status, least_ratio);
  }
  return sum;
}

/// Adds a piece whose first pillar is at (x, y); all but the peak.
void add_piece(const PieceSum& piece, std::int64_t pillars, std::int64_t x, std::int64_t y,
               ContactTotals& totals) {
  const std::int64_t shear_x = value_of(piece.shear_x);
  const std::int64_t shear_y = value_of(piece.shear_y.force);
  const std::int64_t normal = value_of(piece.normal.force);
  ContactSum& sum = totals.sum;
  sum.shear_x += shear_x;
  sum.shear_y += shear_y;
  sum.normal += normal;
  sum.normal_x.add_product(normal * x + 2 * value_of(piece.normal.moment));
  sum.normal_y.add_product(normal * y);
  sum.shear_y_x.add_product(shear_y * x + 2 * value_of(piece.shear_y.moment));
  sum.shear_x_y.add_product(shear_x * y);
  sum.x += pillars * (x + pillars - 1);
  sum.y += pillars * y;
  sum.pillars += pillars;
  sum.ambiguous += StatusCounts::total(piece.counts.ambiguous);
  sum.resolved += StatusCounts::total(piece.counts.resolved);
  totals.slip.add(
      {value_of(piece.slip.pressing), value_of(piece.slip.known), value_of(piece.slip.slipping)});
}

/// Asks for what the next runs need: rows are too far apart for a processor to guess.
PF_INLINE void ask_for(std::span<const float> plane, const ForceFieldView& forces,
                       std::span<const ContactRun> runs, std::size_t run) {
#if defined(__GNUC__)
  constexpr std::size_t kAhead = 2;
  constexpr std::uint32_t kLine = 16;
  if (run + kAhead >= runs.size()) return;
  const ContactRun& ahead = runs[run + kAhead];
  const float* const row = plane.data() + std::size_t{ahead.row} * forces.cols;
  for (std::uint32_t col = ahead.first; col < ahead.end + kLine; col += kLine) {
    __builtin_prefetch(row + std::min(col, ahead.end - 1));
  }
#endif
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

}  // namespace

PF_WIDE ContactTotals totals_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                                std::optional<double> least_ratio) {
  const bool with_slip = least_ratio.has_value();
  const auto ratio = static_cast<float>(least_ratio.value_or(0));
  const ForceQuanta quanta(forces.normal.size());
  ContactTotals totals;
  std::int32_t peak = 0;
  ContactRun with_peak;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ContactRun& run = runs[i];
    ask_for(forces.shear_x, forces, runs, i);
    ask_for(forces.shear_y, forces, runs, i);
    ask_for(forces.normal, forces, runs, i);
    for (std::uint32_t first = run.first; first < run.end; first += kPiece) {
      const std::uint32_t end = std::min(first + kPiece, run.end);
      const std::size_t begin = std::size_t{run.row} * forces.cols + first;
      if (!makes_blocks(forces, begin, end - first)) {
        for (std::uint32_t col = first; col < end; ++col) {
          const PillarForce pillar = pillar_at(forces, quanta, run.row, col);
          totals.sum.add(pillar);
          if (with_slip) add_slip(pillar, ratio, totals.slip);
        }
        continue;
      }
      const PieceSum piece = sum_piece(forces, begin, end - first, with_slip, ratio);
      add_piece(piece, end - first, place_x(forces, first), place_y(forces, run.row), totals);
      const std::int32_t largest = largest_of(piece.peaks);
      const ContactRun this_piece = {run.row, first, end, 0};
      // What is masked has no force: less than none is not seen, but it is also rare.
      if (largest == 0) add_peak(forces, quanta, this_piece, totals.sum);
      if (largest <= peak) continue;
      peak = largest;
      with_peak = this_piece;
    }
  }
  add_peak(forces, quanta, with_peak, totals.sum);
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
