#include "calibration/doctor/lying_signals.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace pillarfield {
namespace {

/// Steps down and to the right, modulo 2^32.
struct SenselStep {
  std::uint32_t down;
  std::uint32_t right;
};
constexpr std::uint32_t kBack = ~0U;
/// One of each opposite pair of neighbours; the first two share an edge with the sensel.
constexpr std::array<SenselStep, 4> kPairs = {{{0, 1}, {1, 0}, {1, 1}, {1, kBack}}};
constexpr std::array<SenselStep, 4> kSides = {{{0, 1}, {1, 0}, {0, kBack}, {kBack, 0}}};
/// Part of a round contact's signal that is expected, and share of its peak from which it is flat.
constexpr float kBesidePeak = 0.5F;
constexpr float kFlat = 0.85F;

}  // namespace

LyingSignals::LyingSignals(const Examination& seen, std::uint32_t frame)
    : seen_(seen), signals_(std::as_const(seen.kept).frame(frame)) {
  float most = 0;
  for (std::uint32_t row = 0; row < seen.rows; ++row) {
    for (std::uint32_t col = 0; col < seen.cols; ++col) {
      const float* const signal = at(row, col);
      if (signal == nullptr || *signal <= most) continue;
      most = *signal;
      peak_ = {row, col};
    }
  }
}

const float* LyingSignals::at(std::uint32_t row, std::uint32_t col) const {
  if (row >= seen_.rows || col >= seen_.cols) return nullptr;
  const std::size_t i = seen_.sensel_lying_at(row, col);
  return seen_.good[i] != 0 ? &signals_[i] : nullptr;
}

float LyingSignals::least_under_contact(std::uint32_t row, std::uint32_t col) const {
  std::array<float, 8> around{};
  std::size_t count = 0;
  for (const auto& [down, right] : kPairs) {
    for (const float* const signal : {at(row + down, col + right), at(row - down, col - right)}) {
      if (signal != nullptr) around.at(count++) = *signal;
    }
  }
  if (count < 3) return 0;
  const std::size_t rank = (3 * count + 3) / 4 - 1;
  std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(rank),
                   around.begin() + static_cast<std::ptrdiff_t>(count), std::greater<>());
  return around.at(rank);
}

float LyingSignals::least_under_small_contact(std::uint32_t row, std::uint32_t col) const {
  float least = least_beside_peak(row, col);
  for (const auto& [down, right] : kPairs) {
    const float* const one = at(row + down, col + right);
    const float* const other = at(row - down, col - right);
    if (one != nullptr && other != nullptr) least = std::max(least, std::min(*one, *other));
  }
  return least;
}

float LyingSignals::least_beside_peak(std::uint32_t row, std::uint32_t col) const {
  const std::uint32_t down = row - peak_.first;
  const std::uint32_t right = col - peak_.second;
  const bool is_beside = std::ranges::any_of(
      kSides, [&](const SenselStep& step) { return step.down == down && step.right == right; });
  if (!is_beside) return 0;
  const float peak = *at(peak_.first, peak_.second);
  const float* const opposite = at(peak_.first - down, peak_.second - right);
  float flank = std::numeric_limits<float>::infinity();
  for (const float* const signal : {at(peak_.first + right, peak_.second + down),
                                    at(peak_.first - right, peak_.second - down)}) {
    if (signal != nullptr) flank = std::min(flank, *signal);
  }
  const bool is_peaked = opposite != nullptr && *opposite < kFlat * peak && flank < kFlat * peak;
  if (!is_peaked || flank <= 0) return 0;
  return *opposite <= flank ? kBesidePeak * flank : kBesidePeak * flank * flank / *opposite;
}

}  // namespace pillarfield
