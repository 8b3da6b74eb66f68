#include "core/friction_plateau.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

namespace pillarfield {
namespace {

// Bins are the leading bits of a float, so their edges are exact: 32 ratios and 8 ceilings to an
// octave, the ratios from 2^-5 to 2^5, the ceilings from 1 to 2^5 and all above in the last.
constexpr int kRatioShift = 23 - 5;
constexpr int kCeilingShift = 23 - 3;
constexpr std::uint32_t kFirstRatio = (127 - 5) << 5;
constexpr std::uint32_t kFirstCeiling = 127 << 3;
constexpr std::uint32_t kRatios = 10 * 32;
constexpr std::uint32_t kCeilings = 5 * 8 + 1;

constexpr std::uint32_t kHalfWindow = 3;
constexpr std::uint32_t kWindow = 2 * kHalfWindow + 1;
constexpr double kRoomAbove = 1.15;
constexpr std::int64_t kFewestPillars = 8;

std::uint32_t bits_of(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

std::uint32_t ratio_bin(double ratio) { return (bits_of(ratio) >> kRatioShift) - kFirstRatio; }

std::uint32_t ceiling_bin(double ceiling) {
  if (!(ceiling > 1)) return 0;
  return std::min((bits_of(ceiling) >> kCeilingShift) - kFirstCeiling, kCeilings - 1);
}

/// The ratio in the middle of a bin.
double middle_of(std::uint32_t bin) {
  const std::uint32_t half = 1u << (kRatioShift - 1);
  return std::bit_cast<float>(((bin + kFirstRatio) << kRatioShift) + half);
}

/// The lowest bin all of whose ceilings leave room above a ratio.
std::uint32_t least_ceiling_bin(double ratio) {
  return std::min(ceiling_bin(kRoomAbove * ratio) + 1, kCeilings - 1);
}

/// Sums over the pillars that could have shown more than the ratios looked at, by ratio.
struct Evidence {
  std::array<std::int64_t, kRatios> weight{};
  std::array<std::int64_t, kRatios> moment{};
  std::array<std::int64_t, kRatios> pillars{};
  std::int64_t all_weight = 0;
};

std::int64_t sum(const std::array<std::int64_t, kRatios>& values, std::uint32_t first,
                 std::uint32_t count) {
  const std::int64_t* const begin = values.data() + first;
  return std::accumulate(begin, begin + std::min(count, kRatios - first), std::int64_t{0});
}

/// Whether the window from bin `first` is a plateau of weight `within`.
bool is_plateau(const Evidence& evidence, std::uint32_t first, std::int64_t within,
                std::int64_t low_weight) {
  const std::uint32_t below_first = first < kWindow ? 0 : first - kWindow;
  const std::int64_t below = sum(evidence.weight, below_first, first - below_first);
  const std::int64_t above = sum(evidence.weight, first + kWindow, kRatios - first - kWindow);
  return 100 * within >= 15 * (evidence.all_weight + low_weight) && 10 * above <= within &&
         5 * below <= 2 * within && sum(evidence.pillars, first, kWindow) >= kFewestPillars;
}

}  // namespace

void FrictionHistogram::add(double ratio, std::uint32_t weight, double ceiling) {
  if (weight == 0) return;
  weight = std::min(weight, kMostWeight);
  all_weight_ += weight;
  if (ratio < kLeastRatio) low_weight_ += weight;
  // Also false for NaN.
  if (!(ratio >= kLeastRatio && ratio < kMostRatio)) return;
  if (cells_.empty()) cells_.resize(std::size_t{kCeilings} * kRatios);
  // The float nearest to a ratio just below the end is the end itself.
  const std::uint32_t bin = std::min(ratio_bin(ratio), kRatios - 1);
  const std::uint32_t place = ceiling_bin(ceiling) * kRatios + bin;
  Cell& cell = cells_[place];
  if (cell.pillars == 0) touched_.push_back(place);
  cell.weight += weight;
  cell.moment += weight * static_cast<std::int64_t>(ratio * 65536);
  ++cell.pillars;
}

void FrictionHistogram::clear() {
  for (const std::uint32_t place : touched_) cells_[place] = {};
  touched_.clear();
  all_weight_ = 0;
  low_weight_ = 0;
}

std::optional<FrictionPlateau> FrictionHistogram::plateau() const {
  by_ceiling_.assign(touched_.begin(), touched_.end());
  std::sort(by_ceiling_.begin(), by_ceiling_.end(), std::greater<>());
  Evidence evidence;
  std::optional<FrictionPlateau> best;
  std::int64_t most = 0;
  std::size_t taken = 0;
  std::uint32_t lowest = kRatios;
  std::uint32_t highest = 0;
  for (const std::uint32_t place : touched_) {
    lowest = std::min(lowest, place % kRatios);
    highest = std::max(highest, place % kRatios);
  }
  // From the highest ratio down, for then the pillars with room above only grow in number.
  for (std::uint32_t first = std::min(highest, kRatios - kWindow) + 1; first-- > 0;) {
    if (first + kWindow <= lowest) break;
    const std::uint32_t least = least_ceiling_bin(middle_of(first + kHalfWindow)) * kRatios;
    for (; taken < by_ceiling_.size() && by_ceiling_[taken] >= least; ++taken) {
      const Cell& cell = cells_[by_ceiling_[taken]];
      const std::uint32_t bin = by_ceiling_[taken] % kRatios;
      evidence.weight.at(bin) += cell.weight;
      evidence.moment.at(bin) += cell.moment;
      evidence.pillars.at(bin) += cell.pillars;
      evidence.all_weight += cell.weight;
    }
    const std::int64_t within = sum(evidence.weight, first, kWindow);
    if (within < most || within == 0 || !is_plateau(evidence, first, within, low_weight_)) {
      continue;
    }
    most = within;
    const auto weight = static_cast<double>(within);
    best = {static_cast<double>(sum(evidence.moment, first, kWindow)) / weight / 65536,
            weight / static_cast<double>(all_weight_)};
  }
  return best;
}

}  // namespace pillarfield
