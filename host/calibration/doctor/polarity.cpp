#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Ratio of the squares that speak for one polarity and for the other that decides.
constexpr double kDecisive = 3;
/// Distance of a load from the levels of sensels that do not change, in deviations of these.
constexpr double kLoadStandsOut = 4;
/// Share of the largest span from which a change is load: drift is below.
constexpr double kLoadChange = 0.3;
/// Moving contacts load at most the first share of all sensels that they ever load at a time, so
/// that each of these is mostly at rest, and ever load at least the second share of the array.
constexpr double kMovingShare = 0.12;
constexpr double kMovedOver = 0.3;
constexpr std::size_t kLeastStill = 6;
constexpr double kStillShare = 0.2;
constexpr double kTrimmed = 0.02;

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

Polarity decide(double rise, double fall) {
  if (rise > kDecisive * fall) return Polarity::rises;
  return fall > kDecisive * rise ? Polarity::falls : Polarity::unknown;
}

/// The sensels that change, and those that do not.
class Changes {
 public:
  explicit Changes(const Examination& seen) : seen_(seen), least_(kLoadChange * seen.span) {
    SenselReadings readings;
    middles_.resize(seen.kept.sensels());
    for (std::size_t i = 0; i < middles_.size(); ++i) {
      if (!seen.is_steady(i)) continue;
      seen.kept.read_sensel(i, readings);
      middles_[i] = median(readings.values);
      const bool changes = seen.sudden[i] != 0 && seen.highest[i] - seen.lowest[i] > least_;
      (changes ? changing_ : still_).push_back(i);
    }
  }

  /// By contacts that move over the array: most of the time a sensel is at rest.
  [[nodiscard]] Polarity by_moving() const {
    std::vector<std::uint8_t> ever(middles_.size());
    double rise = 0;
    double fall = 0;
    double loaded = 0;
    double frames = 0;
    for (std::size_t frame = 0; frame < seen_.kept.frames(); ++frame) {
      const auto values = std::as_const(seen_.kept).frame(frame);
      double count = 0;
      for (const std::size_t i : changing_) {
        const double change = values[i] - middles_[i];
        if (!(std::abs(change) > std::max(least_, seen_.threshold(i)))) continue;
        (change > 0 ? rise : fall) += change * change;
        ever[i] = 1;
        ++count;
      }
      loaded += count;
      frames += count > 0 ? 1 : 0;
    }
    const auto all = static_cast<double>(std::ranges::count(ever, 1));
    const bool moves = all > kMovedOver * static_cast<double>(middles_.size()) &&
                       loaded < kMovingShare * frames * all;
    return moves ? decide(rise, fall) : Polarity::unknown;
  }

  /// By place: at rest, sensels that change read as those that do not; if nearly all change, their
  /// readings resemble each other more than under load.
  [[nodiscard]] Polarity by_rest() const {
    const auto values_of = [](const auto& of, const std::vector<std::size_t>& sensels) {
      std::vector<double> values;
      for (const std::size_t i : sensels) values.push_back(of[i]);
      return values;
    };
    std::vector<double> low = values_of(seen_.lowest, changing_);
    std::vector<double> high = values_of(seen_.highest, changing_);
    const auto all = static_cast<double>(changing_.size() + still_.size());
    const auto still = static_cast<double>(still_.size());
    if (still < std::max<double>(kLeastStill, kStillShare * all)) {
      if (changing_.size() < kLeastStill) return Polarity::unknown;
      return decide(trimmed_variance(std::move(high)), trimmed_variance(std::move(low)));
    }
    std::vector<double> levels = values_of(middles_, still_);
    const double rest = median(levels);
    const double spread =
        std::max((quantile(levels, 0.98) - quantile(levels, 0.02)) / 4, seen_.typical_noise);
    double rise = 0;
    double fall = 0;
    double noise = 0;
    for (std::size_t n = 0; n < low.size(); ++n) {
      const double beyond = 2.5 * seen_.noise_of(changing_[n]);  // of an extreme reading
      rise += std::pow(std::max(0.0, std::abs(high[n] - rest) - beyond), 2);
      fall += std::pow(std::max(0.0, std::abs(low[n] - rest) - beyond), 2);
      noise += std::pow(kLoadStandsOut * spread, 2);
    }
    return std::max(rise, fall) > noise ? decide(rise, fall) : Polarity::unknown;
  }

 private:
  const Examination& seen_;
  double least_;
  std::vector<float> middles_;
  std::vector<std::size_t> changing_;
  std::vector<std::size_t> still_;
};

}  // namespace

Polarity find_polarity(const Examination& seen) {
  if (!(seen.span > 0)) return Polarity::unknown;
  const Changes changes(seen);
  const Polarity moving = changes.by_moving();
  return moving != Polarity::unknown ? moving : changes.by_rest();
}

}  // namespace pillarfield
