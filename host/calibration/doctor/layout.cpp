#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Multiple of the noise's power that groups of four must differ by.
constexpr double kAboveNoise = 4;
/// Ratios up to which groups share pillars, and from which they do not.
constexpr double kPillarRatio = 0.3;
constexpr double kSenselRatio = 0.7;
constexpr double kLeastGroups = 200;

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

}  // namespace

void find_layout(const Examination& seen, Diagnosis& found) {
  GroupParity aligned;
  GroupParity others;
  for (const std::uint32_t frame : seen.contacts) {
    add_groups(seen, frame, 0, 0, aligned);
    add_groups(seen, frame, 0, 1, others);
    add_groups(seen, frame, 1, 0, others);
    add_groups(seen, frame, 1, 1, others);
  }
  if (aligned.groups < kLeastGroups || others.groups < kLeastGroups) return;
  if (others.squares < kAboveNoise * others.noise || others.power() == 0) return;
  found.layout_ratio = std::sqrt(aligned.power() / others.power());
  if (*found.layout_ratio < kPillarRatio) found.layout = ArrayLayout::pillars;
  if (*found.layout_ratio > kSenselRatio) found.layout = ArrayLayout::sensels;
}

}  // namespace pillarfield
