#include "core/friction_plateau.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

namespace pillarfield {
namespace {

constexpr std::uint32_t kHalfWindow = 3;
constexpr std::uint32_t kWindow = 2 * kHalfWindow + 1;
constexpr float kRoomAbove = 1.15F;
constexpr std::int64_t kFewestPillars = 8;

constexpr std::uint32_t kRatios = RatioBins::kRatios;
constexpr std::uint32_t kCeilings = RatioBins::kCeilings;

/// The lowest bin all of whose ceilings leave room above a ratio.
std::uint32_t least_ceiling_bin(float ratio) {
  return std::min(RatioBins::of_ceiling(kRoomAbove * ratio) + 1, kCeilings - 1);
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
    const std::uint32_t least =
        least_ceiling_bin(RatioBins::middle_of(first + kHalfWindow)) * kRatios;
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
