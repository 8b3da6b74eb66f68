#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Multiple of the noise's power that groups of four must differ by.
constexpr double kAboveNoise = 4;
/// Ratios up to which groups share pillars, and from which they do not.
constexpr double kPillarRatio = 0.4;
constexpr double kSenselRatio = 0.5;
constexpr std::size_t kLeastGroups = 200;  ///< in all frames
constexpr std::size_t kLeastPlaces = 16;
constexpr double kLeastGroupLoad = 0.3;  ///< of a group's most loaded sensel, in the usual peak

/// Sums over frames of a group of four sensels: of the squares of its parity, of its load and of
/// its noise.
struct GroupParity {
  double squares = 0;
  double loads = 0;
  double noise = 0;
  std::size_t frames = 0;
};

/// Adds a frame to the group that begins with a sensel, unless one of its sensels is not good.
void add_frame(const Examination& seen, std::span<const float> signals, std::size_t first,
               GroupParity& parity) {
  double load = 0;
  double difference = 0;
  double noise = 0;
  float largest = 0;
  for (const std::size_t i : {first, first + 1, first + seen.cols, first + seen.cols + 1}) {
    if (seen.good[i] == 0) return;
    const bool is_on_diagonal = i == first || i == first + seen.cols + 1;
    largest = std::max(largest, signals[i]);
    load += signals[i];
    difference += is_on_diagonal ? signals[i] : -signals[i];
    noise += std::pow(seen.noise_of(i), 2);
  }
  if (largest < kLeastGroupLoad * seen.contact_counts) return;
  parity.squares += difference * difference;
  parity.loads += load * load;
  parity.noise += noise;
  ++parity.frames;
}

/// Parity of groups that may stand under pillars, relative to that of others: of medians, since
/// shorted lines change some groups.
std::optional<double> parity_ratio(const Examination& seen) {
  std::vector<GroupParity> groups(seen.kept.sensels());
  for (const std::uint32_t frame : seen.contacts) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    for (std::size_t row = 0; row + 1 < seen.rows; ++row) {
      for (std::size_t col = 0; col + 1 < seen.cols; ++col) {
        const std::size_t first = row * seen.cols + col;
        add_frame(seen, signals, first, groups[first]);
      }
    }
  }
  std::array<std::vector<double>, 2> powers;  // of groups that may be pillars, of others
  std::array<std::size_t, 2> frames{};
  GroupParity others;
  for (std::size_t first = 0; first < groups.size(); ++first) {
    const GroupParity& parity = groups[first];
    if (parity.frames == 0) continue;
    const std::size_t which = first / seen.cols % 2 == 0 && first % seen.cols % 2 == 0 ? 0 : 1;
    frames.at(which) += parity.frames;
    powers.at(which).push_back(std::max(0.0, parity.squares - parity.noise) / parity.loads);
    others.squares += which == 0 ? 0 : parity.squares;
    others.noise += which == 0 ? 0 : parity.noise;
  }
  if (std::ranges::min(frames) < kLeastGroups || others.squares < kAboveNoise * others.noise) {
    return std::nullopt;
  }
  if (std::min(powers[0].size(), powers[1].size()) < kLeastPlaces) return std::nullopt;
  const double usual = median(powers[1]);
  return usual > 0 ? std::optional(std::sqrt(median(powers[0]) / usual)) : std::nullopt;
}

}  // namespace

bool may_have_pillars(const Diagnosis& found) {
  return found.layout_ratio && found.layout != ArrayLayout::sensels;
}

void find_layout(const Examination& seen, Diagnosis& found) {
  found.layout_ratio = parity_ratio(seen);
  if (!found.layout_ratio) return;
  if (*found.layout_ratio < kPillarRatio) found.layout = ArrayLayout::pillars;
  if (*found.layout_ratio > kSenselRatio) found.layout = ArrayLayout::sensels;
}

}  // namespace pillarfield
