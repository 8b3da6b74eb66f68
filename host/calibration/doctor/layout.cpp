#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Multiple of the noise's power that groups of four must differ by.
constexpr double kAboveNoise = 4;
/// Ratios up to which groups share pillars, and from which they do not.
constexpr double kPillarRatio = 0.4;
constexpr double kSenselRatio = 0.7;
constexpr double kLeastGroups = 200;
constexpr std::size_t kLeastPairs = 4;
constexpr double kLeastDifferent = 0.05;

/// Squares of the parity of groups of four loaded sensels.
struct GroupParity {
  double squares = 0;
  double noise = 0;
  double groups = 0;
  [[nodiscard]] double power() const { return std::max(0.0, squares - noise) / groups; }
};

/// Adds the groups whose first row and column are `row` and `col` plus multiples of two.
void add_groups(const Examination& seen, std::uint32_t frame, std::uint32_t row, std::uint32_t col,
                GroupParity& parity) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  const double least = 0.3 * seen.contact_counts;
  for (std::size_t r = row; r + 1 < seen.rows; r += 2) {
    for (std::size_t c = col; c + 1 < seen.cols; c += 2) {
      const std::size_t first = r * seen.cols + c;
      const std::array<std::size_t, 4> group = {first, first + 1, first + seen.cols + 1,
                                                first + seen.cols};
      double sum = 0;
      double noise = 0;
      double largest = 0;
      bool is_good = true;
      for (std::size_t n = 0; n < 4; ++n) {
        const std::size_t i = group.at(n);
        is_good = is_good && seen.good[i] != 0;
        largest = std::max<double>(largest, signals[i]);
        sum += n % 2 == 0 ? signals[i] : -signals[i];
        noise += std::pow(std::max<double>(seen.noise[i], seen.typical_noise), 2);
      }
      if (!is_good || largest < least) continue;
      parity.squares += sum * sum;
      parity.noise += noise;
      ++parity.groups;
    }
  }
}

/// Parity of groups that may stand under pillars, relative to that of others.
std::optional<double> parity_ratio(const Examination& seen) {
  GroupParity aligned;
  GroupParity others;
  for (const std::uint32_t frame : seen.contacts) {
    add_groups(seen, frame, 0, 0, aligned);
    add_groups(seen, frame, 0, 1, others);
    add_groups(seen, frame, 1, 0, others);
    add_groups(seen, frame, 1, 1, others);
  }
  if (aligned.groups < kLeastGroups || others.groups < kLeastGroups) return std::nullopt;
  if (others.squares < kAboveNoise * others.noise || others.power() == 0) return std::nullopt;
  return std::sqrt(aligned.power() / others.power());
}

/// Difference of lines that may run under the same pillars, relative to that of others.
std::optional<double> pair_ratio(const Examination& seen) {
  std::array<std::vector<double>, 2> differences;  // of the same pillars, of others
  for (const LineAxis axis : {LineAxis::rows, LineAxis::columns}) {
    const auto found = neighbour_differences(seen, axis);
    for (std::size_t line = 0; line < found.size(); ++line) {
      if (found[line]) differences.at(line % 2).push_back(*found[line]);
    }
  }
  auto& [same, others] = differences;
  if (same.size() < kLeastPairs || others.size() < kLeastPairs) return std::nullopt;
  const double usual = median(others);
  return usual > kLeastDifferent ? std::optional(median(same) / usual) : std::nullopt;
}

}  // namespace

bool may_have_pillars(const Diagnosis& found) {
  return found.layout_ratio && found.layout != ArrayLayout::sensels;
}

void find_layout(const Examination& seen, Diagnosis& found) {
  const std::optional<double> parity = parity_ratio(seen);
  const std::optional<double> pairs = pair_ratio(seen);
  if (!parity && !pairs) return;
  found.layout_ratio =
      std::min(parity.value_or(pairs.value_or(1)), pairs.value_or(parity.value_or(1)));
  if (*found.layout_ratio < kPillarRatio) found.layout = ArrayLayout::pillars;
  if (*found.layout_ratio > kSenselRatio) found.layout = ArrayLayout::sensels;
}

}  // namespace pillarfield
