#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"

namespace pillarfield {
namespace {

/// LineDifference of two shorted lines, relative to their signals: of their readings, and, where a
/// small contact swept over the lines, of what no gains of single sensels explain.
constexpr double kMostUnequal = 0.03;
constexpr double kMostGainDifference = 0.5;
constexpr double kMostUnexplained = 0.1;
/// Least difference of each from its other neighbours.
constexpr double kLeastDifference = 0.12;
constexpr double kShortRatio = 0.3;
constexpr std::size_t kLeastShared = 3;  ///< sensels of a line
constexpr double kLeastPower = 4;        ///< of the signals of loaded sensels, over that of noise
constexpr double kMostProducts = 4e9;
constexpr std::size_t kLeastHeaviest = 4;  ///< lines that are the most loaded ones in turn

/// Frames of contacts, thinned so that all pairs of lines can be compared.
std::vector<std::uint32_t> compared_frames(const Examination& seen, LineAxis axis) {
  const double each =
      static_cast<double>(seen.lines(axis)) * static_cast<double>(seen.kept.sensels());
  const auto most = static_cast<std::size_t>(std::max(8.0, kMostProducts / each));
  const std::size_t step = seen.contacts.size() / most + 1;
  std::vector<std::uint32_t> frames;
  for (std::size_t i = 0; i < seen.contacts.size(); i += step) frames.push_back(seen.contacts[i]);
  return frames;
}

struct LineDifference {
  double unequal;
  double unexplained;
};

/// Signals of contacts as [along, line, frame].
class LineSignals {
 public:
  LineSignals(const Examination& seen, LineAxis axis)
      : seen_(seen), axis_(axis), frames_(compared_frames(seen, axis)) {
    signals_.resize(frames_.size() * seen.kept.sensels());
    const std::size_t lines = seen.lines(axis);
    const std::size_t length = seen.kept.sensels() / lines;
    std::size_t at = 0;
    for (std::size_t along = 0; along < length; ++along) {
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t sensel = seen.sensel(axis, line, along);
        for (const std::uint32_t frame : frames_) {
          signals_[at++] = std::as_const(seen.kept).frame(frame)[sensel];
        }
      }
    }
  }

  /// How much the signals of two lines differ, relative to those of the weaker line: the root of
  /// the mean squares of the differences, without noise, and of the smaller eigenvalues of the
  /// second moments, which no gain of a single sensel changes. Unset: too little signal.
  [[nodiscard]] std::optional<LineDifference> difference(std::size_t a, std::size_t b) const {
    const std::size_t lines = seen_.lines(axis_);
    const std::size_t length = seen_.kept.sensels() / lines;
    double unequal = 0;
    double unexplained = 0;
    double first_power = 0;
    double second_power = 0;
    double noise = 0;
    std::size_t shared = 0;
    for (std::size_t along = 0; along < length; ++along) {
      const std::size_t first = seen_.sensel(axis_, a, along);
      const std::size_t second = seen_.sensel(axis_, b, along);
      if (seen_.good[first] == 0 || seen_.good[second] == 0) continue;
      if (seen_.touched[first] < 3 || seen_.touched[second] < 3) continue;
      const PairMoments m =
          moments(along, {a, seen_.threshold(first)}, {b, seen_.threshold(second)});
      const double half = (m.aa - m.bb) / 2;
      unequal += (m.aa + m.bb - 2 * m.ab) / 2;
      unexplained += (m.aa + m.bb) / 2 - std::sqrt(half * half + m.ab * m.ab);
      first_power += m.aa;
      second_power += m.bb;
      noise +=
          m.frames *
          std::pow(std::max<double>({seen_.noise[first], seen_.noise[second], seen_.typical_noise}),
                   2);
      ++shared;
    }
    const double power = std::min(first_power, second_power);
    if (shared < kLeastShared || power < kLeastPower * noise) return std::nullopt;
    const auto relative = [&](double sum) {
      return std::sqrt(std::max(0.0, sum - noise) / (power - noise));
    };
    return LineDifference{relative(unequal), relative(unexplained)};
  }

 private:
  /// Second moments of two sensels, of frames in which one of them is loaded.
  struct PairMoments {
    float frames = 0;
    float aa = 0;
    float ab = 0;
    float bb = 0;
  };
  struct LineThreshold {
    std::size_t line;
    double counts;
  };
  [[nodiscard]] PairMoments moments(std::size_t along, const LineThreshold& a,
                                    const LineThreshold& b) const {
    const std::size_t lines = seen_.lines(axis_);
    const float* const x = &signals_[(along * lines + a.line) * frames_.size()];
    const float* const y = &signals_[(along * lines + b.line) * frames_.size()];
    const auto least_x = static_cast<float>(a.counts);
    const auto least_y = static_cast<float>(b.counts);
    PairMoments sum;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const float weight = x[i] > least_x || y[i] > least_y ? 1 : 0;
      sum.frames += weight;
      sum.aa += weight * x[i] * x[i];
      sum.ab += weight * x[i] * y[i];
      sum.bb += weight * y[i] * y[i];
    }
    return sum;
  }

  const Examination& seen_;
  LineAxis axis_;
  std::vector<std::uint32_t> frames_;
  std::vector<float> signals_;
};

/// The least difference of line `a` or `b` from its neighbours other than the two.
double neighbours_difference(const LineSignals& signals, std::size_t lines, std::size_t a,
                             std::size_t b) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t line : {a, b}) {
    for (const std::size_t other : {line - 1, line + 1}) {
      if (other >= lines || other == a || other == b) continue;
      const auto difference = signals.difference(line, other);
      if (difference) least = std::min(least, difference->unexplained);
    }
  }
  return least;
}

bool share_pillars(const Diagnosis& found, std::uint32_t a, std::uint32_t b) {
  return may_have_pillars(found) && a % 2 == 0 && b == a + 1;
}

/// True if loads differ so much that two lines do not resemble each other by chance: many lines
/// carry the largest load at some time.
bool are_loads_unlike(const Examination& seen, LineAxis axis) {
  const std::size_t lines = seen.lines(axis);
  std::set<std::size_t> heaviest;
  for (const std::uint32_t frame : seen.contacts) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    std::vector<double> loads(lines);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const std::size_t line = axis == LineAxis::rows ? i / seen.cols : i % seen.cols;
      if (seen.good[i] != 0 && signals[i] > seen.threshold(i)) loads[line] += signals[i];
    }
    heaviest.insert(static_cast<std::size_t>(std::ranges::max_element(loads) - loads.begin()));
  }
  return heaviest.size() >= std::min(kLeastHeaviest, lines);
}

void find_shorted_lines(Examination& seen, LineAxis axis, Diagnosis& found) {
  if (!are_loads_unlike(seen, axis)) return;
  const bool was_swept = is_swept(seen, axis);
  const LineSignals signals(seen, axis);
  const std::size_t lines = seen.lines(axis);
  for (std::uint32_t a = 0; a < lines; ++a) {
    for (std::uint32_t b = a + 1; b < lines; ++b) {
      const auto difference = signals.difference(a, b);
      if (!difference || share_pillars(found, a, b)) continue;
      const bool is_equal = difference->unequal < kMostUnequal;
      const bool is_explained = was_swept && difference->unexplained < kMostUnexplained &&
                                difference->unequal < kMostGainDifference;
      if (!is_equal && !is_explained) continue;
      const double others = neighbours_difference(signals, lines, a, b);
      if (!std::isfinite(others) || others < kLeastDifference ||
          difference->unexplained > kShortRatio * others) {
        continue;
      }
      seen.shorted.push_back({axis, a, b});
      const bool are_rows = axis == LineAxis::rows;
      add(found, {.fault = are_rows ? ArrayFault::shorted_rows : ArrayFault::shorted_columns,
                  .lines = {a, b},
                  .figure = 100 * difference->unequal});
    }
  }
}

}  // namespace

std::vector<std::optional<double>> neighbour_differences(const Examination& seen, LineAxis axis) {
  const LineSignals signals(seen, axis);
  std::vector<std::optional<double>> differences;
  for (std::size_t line = 0; line + 1 < seen.lines(axis); ++line) {
    const auto difference = signals.difference(line, line + 1);
    differences.push_back(difference ? std::optional(difference->unexplained) : std::nullopt);
  }
  return differences;
}

void find_shorts(Examination& seen, Diagnosis& found) {
  if (seen.contacts.size() < 10) return;
  find_shorted_lines(seen, LineAxis::rows, found);
  find_shorted_lines(seen, LineAxis::columns, found);
}

}  // namespace pillarfield
