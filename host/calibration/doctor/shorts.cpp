#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"

namespace pillarfield {
namespace {

/// Largest difference of two shorted lines, relative to their signals, where contacts swept over
/// the lines and where they did not, and relative to the difference from their neighbours.
constexpr double kMostUnequalSwept = 0.12;
constexpr double kMostUnequal = 0.04;
constexpr double kShortRatio = 0.2;
constexpr std::size_t kLeastShared = 3;  ///< sensels of a line
constexpr double kLeastPower = 4;        ///< of the signals of loaded sensels, over that of noise
constexpr double kMostProducts = 4e9;
/// Lines by which the centre of pressure must move: contacts at rest can load lines equally.
constexpr double kLeastMove = 0.2;

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
  double unexplained;  ///< by gains of single sensels
};

/// Signals of contacts as [along, line, frame].
class LineSignals {
 public:
  LineSignals(const Examination& seen, LineAxis axis)
      : seen_(seen), axis_(axis), frames_(compared_frames(seen, axis)) {
    signals_.reserve(frames_.size() * seen.kept.sensels());
    const std::size_t lines = seen.lines(axis);
    for (std::size_t along = 0; along < seen.kept.sensels() / lines; ++along) {
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t sensel = seen.sensel(axis, line, along);
        for (const std::uint32_t frame : frames_) {
          signals_.push_back(std::as_const(seen.kept).frame(frame)[sensel]);
        }
      }
    }
  }

  /// Difference of the signals of two lines, relative to those of the weaker line: the root of the
  /// mean squares of the differences, without noise, and of the smaller eigenvalues of the second
  /// moments, which no gain of a single sensel changes. Unset: too little signal.
  [[nodiscard]] std::optional<LineDifference> difference(std::size_t a, std::size_t b) const {
    const std::size_t lines = seen_.lines(axis_);
    double unequal = 0;
    double unexplained = 0;
    double first_power = 0;
    double second_power = 0;
    double noise = 0;
    std::size_t shared = 0;
    for (std::size_t along = 0; along < seen_.kept.sensels() / lines; ++along) {
      const std::size_t first = seen_.sensel(axis_, a, along);
      const std::size_t second = seen_.sensel(axis_, b, along);
      if (seen_.good[first] == 0 || seen_.good[second] == 0) continue;
      if (seen_.touched[first] < 3 || seen_.touched[second] < 3) continue;
      const float* const x = &signals_[(along * lines + a) * frames_.size()];
      const float* const y = &signals_[(along * lines + b) * frames_.size()];
      const auto least_x = static_cast<float>(seen_.threshold(first));
      const auto least_y = static_cast<float>(seen_.threshold(second));
      float frames = 0;
      float xx = 0;
      float xy = 0;
      float yy = 0;
      for (std::size_t i = 0; i < frames_.size(); ++i) {
        const float weight = x[i] > least_x || y[i] > least_y ? 1 : 0;
        frames += weight;
        xx += weight * x[i] * x[i];
        xy += weight * x[i] * y[i];
        yy += weight * y[i] * y[i];
      }
      unequal += (xx + yy - 2 * xy) / 2;
      unexplained += (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy);
      first_power += xx;
      second_power += yy;
      const auto deviation =
          std::max<double>({seen_.noise[first], seen_.noise[second], seen_.typical_noise});
      noise += frames * deviation * deviation;
      ++shared;
    }
    const double power = std::min(first_power, second_power);
    if (shared < kLeastShared || power < kLeastPower * noise) return std::nullopt;
    const auto relative = [&](double sum) {
      return std::sqrt(std::max(0.0, sum - noise) / (power - noise));
    };
    return LineDifference{relative(unequal), relative(unexplained)};
  }

  /// The least difference of line `a` or `b` from its neighbours other than the two.
  [[nodiscard]] double difference_from_neighbours(std::size_t a, std::size_t b) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t line : {a, b}) {
      for (const std::size_t other : {line - 1, line + 1}) {
        if (other >= seen_.lines(axis_) || other == a || other == b) continue;
        if (const auto found = difference(line, other)) least = std::min(least, found->unequal);
      }
    }
    return least;
  }

 private:
  const Examination& seen_;
  LineAxis axis_;
  std::vector<std::uint32_t> frames_;
  std::vector<float> signals_;
};

bool share_pillars(const Diagnosis& found, std::uint32_t a, std::uint32_t b) {
  return may_have_pillars(found) && a % 2 == 0 && b == a + 1;
}

/// The loads of lines in frames of contacts, and where their centre of pressure lies.
class LineCentres {
 public:
  LineCentres(const Examination& seen, LineAxis axis) {
    for (const std::uint32_t frame : seen.contacts) {
      const auto signals = std::as_const(seen.kept).frame(frame);
      std::vector<float>& loads = loads_.emplace_back(seen.lines(axis));
      double sum = 0;
      double moment = 0;
      for (std::size_t i = 0; i < signals.size(); ++i) {
        if (seen.good[i] == 0 || signals[i] < seen.threshold(i)) continue;
        const std::size_t line = axis == LineAxis::rows ? i / seen.cols : i % seen.cols;
        loads[line] += signals[i];
        sum += signals[i];
        moment += static_cast<double>(signals[i]) * static_cast<double>(line);
      }
      centres_.push_back(sum > 0 ? moment / sum : 0);
    }
  }

  /// Way of the centre across the lines, but for its ends, while a line is loaded.
  [[nodiscard]] double way(std::size_t line) const {
    std::vector<double> centres;
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      if (loads_[i][line] > 0) centres.push_back(centres_[i]);
    }
    return centres.empty() ? 0 : quantile(centres, 0.95) - quantile(centres, 0.05);
  }

 private:
  std::vector<std::vector<float>> loads_;  ///< [frame][line]
  std::vector<double> centres_;
};

void find_shorted_lines(Examination& seen, LineAxis axis, Diagnosis& found) {
  const LineCentres centres(seen, axis);
  const double most = is_swept(seen, axis) ? kMostUnequalSwept : kMostUnequal;
  const LineSignals signals(seen, axis);
  for (std::uint32_t a = 0; a < seen.lines(axis); ++a) {
    for (std::uint32_t b = a + 1; b < seen.lines(axis); ++b) {
      if (share_pillars(found, a, b)) continue;
      const auto difference = signals.difference(a, b);
      if (!difference || difference->unequal > most || centres.way(a) < kLeastMove) continue;
      const double others = signals.difference_from_neighbours(a, b);
      if (!std::isfinite(others) || difference->unequal > kShortRatio * others) continue;
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
  // Lines that lie apart show contacts in two places; one of them is wrong.
  for (const auto& [axis, first, second] : seen.shorted) {
    if (second - first == 1) continue;
    for (const std::uint32_t line : {first, second}) {
      for (std::size_t along = 0; along < seen.kept.sensels() / seen.lines(axis); ++along) {
        seen.good[seen.sensel(axis, line, along)] = 0;
      }
    }
  }
}

}  // namespace pillarfield
