#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Power of the difference of two shorted lines, relative to what the lines beside them predict.
constexpr double kShortedPower = 0.05;
/// The same in their own power, of the first and the last line.
constexpr double kShortedEnds = 0.01;
/// Largest difference of shorted lines, in their signals.
constexpr double kShortedDifference = 0.1;
/// Difference of the lines beside a pair, in its load, of a load that tells.
constexpr double kTellingSlope = 0.3;
/// Different places of loads of either shape.
constexpr std::size_t kShapePlaces = 5;
constexpr double kPowerOverNoise = 20;
constexpr std::size_t kComparedFrames = 1024;
constexpr std::size_t kLeastShortLines = 6;

/// Loads of one shape on a pair of lines: more load before the pair, or behind it.
struct ShapeOfLoad {
  double difference = 0;  ///< squares, less those of noise
  double expected = 0;
  double noise = 0;
  std::set<std::pair<long, long>> places = {};

  [[nodiscard]] bool tells() const {
    return places.size() >= kShapePlaces && expected > kPowerOverNoise * noise;
  }
};

class PairOfLines {
 public:
  PairOfLines(const Examination& seen, LineAxis axis, std::uint32_t first, std::uint32_t second)
      : seen_(seen), axis_(axis), first_(first), second_(second) {
    const std::size_t step = seen.contacts.size() / kComparedFrames + 1;
    for (std::size_t n = 0; n < seen.contacts.size(); n += step) add(seen.contacts[n]);
  }

  /// True if the lines read the same under loads of unlike shape.
  [[nodiscard]] bool are_shorted() const {
    bool tells = true;
    for (std::size_t side = 0; side < 2; ++side) {
      // At a border nothing is beside the pair on one side.
      if (!are_ends() && !(side == 0 ? first_ > 0 : second_ + 1 < seen_.lines(axis_))) continue;
      const ShapeOfLoad& shape = shapes_.at(side);
      tells = tells && shape.tells() &&
              shape.difference < (are_ends() ? kShortedEnds : kShortedPower) * shape.expected;
    }
    return tells && difference() < kShortedDifference;
  }
  /// Root of the power of the difference in that of the signals.
  [[nodiscard]] double difference() const {
    return std::sqrt(std::max(0.0, shapes_[0].difference + shapes_[1].difference) / power_);
  }

 private:
  [[nodiscard]] bool are_ends() const { return second_ - first_ > 1; }

  /// Signal of a sensel, at least 0; unset where it is not good.
  [[nodiscard]] std::optional<double> signal(std::uint32_t frame, std::size_t line,
                                             std::size_t along) const {
    if (line >= seen_.lines(axis_)) return std::nullopt;
    const std::size_t i = seen_.sensel(axis_, line, along);
    if (seen_.good[i] == 0) return std::nullopt;
    return std::as_const(seen_.kept).frame(frame)[i];
  }

  void add(std::uint32_t frame) {
    std::size_t most = 0;
    double peak = 0;
    for (std::size_t along = 0; along < seen_.kept.sensels() / seen_.lines(axis_); ++along) {
      const double load =
          signal(frame, first_, along).value_or(0) + signal(frame, second_, along).value_or(0);
      if (load > peak) most = along;
      peak = std::max(peak, load);
    }
    for (std::size_t along = 0; along < seen_.kept.sensels() / seen_.lines(axis_); ++along) {
      const auto x = signal(frame, first_, along);
      const auto y = signal(frame, second_, along);
      const double noise = std::max(seen_.noise_of(seen_.sensel(axis_, first_, along)),
                                    seen_.noise_of(seen_.sensel(axis_, second_, along)));
      if (!x || !y || std::max(*x, *y) < 1.5 * kBeyondIdleNoise * noise) continue;
      add(frame, along, most, *x, *y, noise);
    }
  }

  void add(std::uint32_t frame, std::size_t along, std::size_t most, double x, double y,
           double noise) {
    const double mean = (x + y) / 2;
    const auto before = signal(frame, are_ends() ? first_ + 1 : first_ - 1, along);
    const auto behind = signal(frame, are_ends() ? second_ - 1 : second_ + 1, along);
    if (!before && !behind) return;
    double slope = 0;
    if (are_ends()) {
      if (!before || !behind) return;
      const auto middle = signal(frame, seen_.lines(axis_) / 2, along);
      if (!middle || *middle > mean / 2) return;
      slope = *before > *behind ? -mean : mean;
    } else if (before && behind) {
      slope = (*behind - *before) / 3;
    } else {
      slope = (behind ? *behind - mean : mean - *before) / 1.5;
    }
    if (std::abs(slope) < kTellingSlope / 3 * mean) return;
    ShapeOfLoad& shape = shapes_.at(slope < 0 ? 0 : 1);
    shape.difference += (x - y) * (x - y) - 2 * noise * noise;
    shape.expected += slope * slope;
    shape.noise += noise * noise;
    power_ += mean * mean;
    if (along == most) {
      shape.places.insert({static_cast<long>(along), std::lround(2 * slope / mean)});
    }
  }

  const Examination& seen_;
  LineAxis axis_;
  std::uint32_t first_;
  std::uint32_t second_;
  std::array<ShapeOfLoad, 2> shapes_;
  double power_ = 0;
};

}  // namespace

void find_shorts(Examination& seen, Diagnosis& found) {
  if (seen.statistics.skin().has_pillars()) return;
  for (const LineAxis axis : {LineAxis::rows, LineAxis::columns}) {
    const auto lines = static_cast<std::uint32_t>(seen.lines(axis));
    if (lines < 3) continue;
    const auto judge = [&](std::uint32_t first, std::uint32_t second) {
      const PairOfLines pair(seen, axis, first, second);
      if (!pair.are_shorted()) return;
      seen.shorted.push_back({axis, first, second});
      const bool are_rows = axis == LineAxis::rows;
      add(found, {.fault = are_rows ? ArrayFault::shorted_rows : ArrayFault::shorted_columns,
                  .lines = {first, second},
                  .figure = 100 * pair.difference()});
    };
    for (std::uint32_t line = 0; line + 1 < lines; ++line) judge(line, line + 1);
    if (lines >= kLeastShortLines) judge(0, lines - 1);
  }
}

}  // namespace pillarfield
