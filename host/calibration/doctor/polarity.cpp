#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Ratio of the evidence for one polarity and for the other that decides.
constexpr double kDecisive = 3;
/// Share of readings at 0 or at full scale from which the others can only be load.
constexpr double kAtRail = 0.3;

/// Evidence that readings rise and that they fall, such as squares of changes to either side.
struct Evidence {
  double rise = 0;
  double fall = 0;

  void add_change(double change, double least) {
    if (change > least) rise += change * change;
    if (change < -least) fall += change * change;
  }
  [[nodiscard]] Polarity polarity() const {
    if (rise > kDecisive * fall) return Polarity::rises;
    if (fall > kDecisive * rise) return Polarity::falls;
    return Polarity::unknown;
  }
};

/// Mean square of the deviations from the median, without the largest half of them.
double robust_variance(std::vector<float> values) {
  if (values.empty()) return 0;
  const float middle = median(values);
  for (float& value : values) value = std::abs(value - middle);
  return std::pow(median(values), 2);
}

/// What those that are known agree on.
Polarity agreed(std::initializer_list<Polarity> polarities) {
  const auto has = [&](Polarity polarity) { return std::ranges::count(polarities, polarity) > 0; };
  if (has(Polarity::rises) == has(Polarity::falls)) return Polarity::unknown;
  return has(Polarity::rises) ? Polarity::rises : Polarity::falls;
}

/// By readings at 0 or at full scale.
Polarity polarity_by_rails(const Examination& seen) {
  Evidence at_rails;
  std::size_t readings = 0;
  for (std::size_t frame = 0; frame < seen.kept.frames(); ++frame) {
    const auto values = std::as_const(seen.kept).frame(frame);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (seen.constant[i] != 0 || std::isnan(values[i])) continue;
      ++readings;
      at_rails.rise += values[i] == 0 ? 1 : 0;
      at_rails.fall += values[i] >= seen.full_scale ? 1 : 0;
    }
  }
  const double least = kAtRail * static_cast<double>(readings);
  return std::max(at_rails.rise, at_rails.fall) > least ? at_rails.polarity() : Polarity::unknown;
}

/// What the readings of all sensels tell, without drift.
class Changes {
 public:
  Changes(const Examination& seen, const std::vector<float>& slopes) : seen_(seen) {
    SenselReadings readings;
    for (std::size_t i = 0; i < seen.kept.sensels(); ++i) {
      if (seen.constant[i] != 0) continue;
      seen.kept.read_sensel(i, readings);
      for (std::size_t n = 0; n < readings.values.size(); ++n) {
        readings.values[n] -= slopes[i] * static_cast<float>(readings.frames[n]);
      }
      add(readings.values, seen.threshold(i));
    }
  }

  [[nodiscard]] Polarity polarity() const {
    const Polarity by_median = from_median_.polarity();
    // Readings without load resemble each other more than loaded ones.
    const Polarity by_spread =
        Evidence{.rise = robust_variance(high_), .fall = robust_variance(low_)}.polarity();
    const Polarity by_still = by_still_sensels();
    return by_still != Polarity::unknown ? by_still
                                         : agreed({by_median, by_spread, at_ends_.polarity()});
  }

 private:
  void add(std::vector<float>& readings, double least) {
    const float middle = median(readings);
    const float low = quantile(readings, 0.02);
    const float high = quantile(readings, 0.98);
    for (const float value : readings) from_median_.add_change(value - middle, least);
    if (high - low < least) {
      still_.push_back(middle);
      return;
    }
    low_.push_back(low);
    high_.push_back(high);
    if (high - low < 2 * least) return;
    for (const float value : readings) {
      at_ends_.rise += value - low < least ? 1 : 0;
      at_ends_.fall += high - value < least ? 1 : 0;
    }
  }

  /// By the extremes of sensels that change, against those that do not, if these are many.
  [[nodiscard]] Polarity by_still_sensels() const {
    std::vector<float> still = still_;
    if (still.size() < std::max<std::size_t>(8, seen_.kept.sensels() / 5)) {
      return Polarity::unknown;
    }
    const float lowest = quantile(still, 0.02);
    const float highest = quantile(still, 0.98);
    Evidence evidence;
    for (const auto* const extremes : {&low_, &high_}) {
      for (const float value : *extremes) {
        evidence.add_change(value - std::clamp(value, lowest, highest), 3 * seen_.typical_noise);
      }
    }
    return evidence.polarity();
  }

  const Examination& seen_;
  Evidence from_median_;  ///< most sensels are without load for most of the time
  Evidence at_ends_;      ///< readings near the lowest and near the highest one
  std::vector<float> still_;
  std::vector<float> low_;
  std::vector<float> high_;
};

}  // namespace

Polarity find_polarity(const Examination& seen, const std::vector<float>& slopes) {
  const Polarity by_rails = polarity_by_rails(seen);
  return by_rails != Polarity::unknown ? by_rails : Changes(seen, slopes).polarity();
}

}  // namespace pillarfield
