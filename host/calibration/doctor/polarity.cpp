#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Ratio of the evidence for one polarity and for the other that decides.
constexpr double kDecisive = 3;
constexpr double kDecisiveRest = 1.3;  ///< of sensels that change to the level of those that do not
/// Share of the largest span from which a change is load: drift is below.
constexpr double kLoadChange = 0.3;
/// Share of the sensels ever loaded that is loaded at a time: up to the first contacts move all
/// over the array, so that each sensel is mostly at rest; from the second on they need not.
constexpr double kMovingShare = 0.12;
constexpr double kStandingShare = 0.5;
constexpr double kMovedOver = 0.3;  ///< least share of the array that moving contacts load
constexpr double kStillShare = 0.2;
constexpr std::size_t kLeastStill = 8;
constexpr double kTrimmed = 0.02;

/// Evidence that readings rise and that they fall, such as squares of changes to either side.
struct Evidence {
  double rise = 0;
  double fall = 0;

  void add_change(double change) { (change > 0 ? rise : fall) += change * change; }
  [[nodiscard]] Polarity polarity(double ratio = kDecisive) const {
    if (rise > ratio * fall) return Polarity::rises;
    return fall > ratio * rise ? Polarity::falls : Polarity::unknown;
  }
};

/// Variance without the largest and the smallest values.
double trimmed_variance(std::vector<double> values) {
  std::ranges::sort(values);
  const auto cut = static_cast<std::ptrdiff_t>(kTrimmed * static_cast<double>(values.size()));
  double mean = 0;
  double squares = 0;
  double count = 0;
  for (auto at = values.begin() + cut; at != values.end() - cut; ++at) {
    const double step = *at - mean;
    mean += step / ++count;
    squares += step * (*at - mean);
  }
  return count > 0 ? squares / count : 0;
}

/// The ways to tell load from rest, by the places of changes.
class Changes {
 public:
  explicit Changes(const Examination& seen) : seen_(seen), least_(kLoadChange * seen.span) {
    SenselReadings readings;
    middles_.resize(seen.kept.sensels());
    for (std::size_t i = 0; i < middles_.size(); ++i) {
      if (!seen.is_steady(i)) continue;
      seen.kept.read_sensel(i, readings);
      middles_[i] = median(readings.values);
      const bool changes = seen.highest[i] - seen.lowest[i] > least_;
      (changes ? changing_ : still_).push_back(i);
    }
    weigh_frames();
  }

  [[nodiscard]] Polarity polarity() const {
    const auto sensels = static_cast<double>(middles_.size());
    const bool is_local = share_of_ever_ < kMovingShare;
    const bool moves = is_local && static_cast<double>(ever_) > kMovedOver * sensels;
    for (const Polarity found :
         {moves ? from_median_.polarity() : Polarity::unknown,
          by_rest().polarity(has_still() ? kDecisiveRest : kDecisive),
          share_of_ever_ < kStandingShare ? from_median_.polarity() : Polarity::unknown,
          by_first_frames().polarity()}) {
      if (found != Polarity::unknown) return found;
    }
    return by_rest().polarity(1);
  }

 private:
  /// Changes from the medians, and the share of the sensels that change at a time.
  void weigh_frames() {
    std::vector<std::uint8_t> ever(middles_.size());
    double loaded = 0;
    double frames = 0;
    for (std::size_t frame = 0; frame < seen_.kept.frames(); ++frame) {
      const auto values = std::as_const(seen_.kept).frame(frame);
      std::size_t count = 0;
      for (const std::size_t i : changing_) {
        const double change = values[i] - middles_[i];
        if (!(std::abs(change) > std::max(least_, seen_.threshold(i)))) continue;
        from_median_.add_change(change);
        ever[i] = 1;
        ++count;
      }
      loaded += static_cast<double>(count);
      frames += count > 0 ? 1 : 0;
    }
    ever_ = static_cast<std::size_t>(std::ranges::count(ever, 1));
    if (ever_ > 0) share_of_ever_ = loaded / frames / static_cast<double>(ever_);
  }

  [[nodiscard]] bool has_still() const {
    const auto steady = static_cast<double>(changing_.size() + still_.size());
    return static_cast<double>(still_.size()) >=
           std::max<double>(kLeastStill, kStillShare * steady);
  }

  /// At rest, sensels that change read as those that do not; if all change, their readings resemble
  /// each other more than under load.
  [[nodiscard]] Evidence by_rest() const {
    Evidence evidence;
    const auto reading = [](const std::vector<float>& of, const std::vector<std::size_t>& sensels) {
      std::vector<double> values;
      values.reserve(sensels.size());
      for (const std::size_t i : sensels) values.push_back(of[i]);
      return values;
    };
    std::vector<double> low = reading(seen_.lowest, changing_);
    std::vector<double> high = reading(seen_.highest, changing_);
    if (!has_still()) return {trimmed_variance(std::move(high)), trimmed_variance(std::move(low))};
    std::vector<double> still_low = reading(seen_.lowest, still_);
    std::vector<double> still_high = reading(seen_.highest, still_);
    const double rest_low = median(still_low);
    const double rest_high = median(still_high);
    for (std::size_t n = 0; n < low.size(); ++n) {
      evidence.rise += std::pow(high[n] - rest_high, 2);
      evidence.fall += std::pow(low[n] - rest_low, 2);
    }
    return evidence;
  }

  /// Most recordings begin at rest.
  [[nodiscard]] Evidence by_first_frames() const {
    Evidence evidence;
    const std::size_t first = std::max<std::size_t>(3, seen_.kept.frames() / 100);
    for (std::size_t frame = 0; frame < std::min(first, seen_.kept.frames()); ++frame) {
      const auto values = std::as_const(seen_.kept).frame(frame);
      for (const std::size_t i : changing_) {
        if (std::isnan(values[i])) continue;
        evidence.rise += std::pow(seen_.highest[i] - values[i], 2);
        evidence.fall += std::pow(values[i] - seen_.lowest[i], 2);
      }
    }
    return evidence;
  }

  const Examination& seen_;
  double least_;
  std::vector<float> middles_;
  std::vector<std::size_t> changing_;
  std::vector<std::size_t> still_;
  Evidence from_median_;
  std::size_t ever_ = 0;
  double share_of_ever_ = 1;  ///< that changes at a time
};

}  // namespace

Polarity find_polarity(const Examination& seen) {
  return seen.span > 0 ? Changes(seen).polarity() : Polarity::unknown;
}

}  // namespace pillarfield
