#include "pillarfield/tare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantile.h"
#include "calibration/finding_list.h"
#include "pillarfield/error.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// A reading this many spreads from the median of its fellows is far from them.
constexpr double kFar = 6;
/// Noise this many times the median of its fellows' is no noise.
constexpr double kNoisy = 10;
/// Of so many pillars that stand out as a whole, each having at least so many sensels that tell, it
/// is said that something touches them.
constexpr std::size_t kTouchedPillars = 2;
constexpr int kTellingSensels = 3;

/// What the sensels that can be right have in common.
struct Typical {
  double tare = 0;
  double spread = 0;  ///< of the tares, as a standard deviation
  double noise = 0;
};

/// The least standard deviation that a reading has: whole counts are rounded.
double least_noise(SenselType type) { return type == SenselType::f32 ? 0 : 1 / std::sqrt(12.0); }

double noise_of(const SenselStatistics& sensel, SenselType type) {
  return std::max(sensel.deviation(), least_noise(type));
}

bool is_constant(const SenselStatistics& sensel) { return sensel.lowest == sensel.highest; }

Typical typical_of(const FrameStatistics& unloaded, const FindingList& found) {
  std::vector<double> tares;
  std::vector<double> noises;
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    if (!found.good(i)) continue;
    tares.push_back(unloaded.sensels()[i].mean);
    noises.push_back(noise_of(unloaded.sensels()[i], unloaded.type()));
  }
  if (tares.empty()) {
    throw Error(unloaded.name(), "no sensel gives readings that could be those of unloaded skin",
                "check the sensor, its full scale and its mask");
  }
  Typical typical;
  typical.tare = median(tares);
  typical.noise = median(noises);
  for (double& tare : tares) tare = std::abs(tare - typical.tare);
  // The median deviation of a normal distribution is 0.6745 of its standard deviation.
  typical.spread = std::max(1.4826 * median(tares), typical.noise);
  return typical;
}

void mask_those_without_tare(const FrameStatistics& unloaded, FindingList& found) {
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    const SenselStatistics& sensel = unloaded.sensels()[i];
    if (!found.good(i)) continue;
    if (2 * sensel.readings < unloaded.frames() || sensel.readings < 2) {
      found.mask(i, SenselFault::not_a_number);
    } else if (2 * sensel.saturated > sensel.readings) {
      found.mask(i, SenselFault::saturated);
    }
  }
}

/// Tells sensels that can be right from those that cannot, by their fellows.
class Judge {
 public:
  Judge(const FrameStatistics& unloaded, const Typical& typical)
      : unloaded_(unloaded), typical_(typical) {}

  [[nodiscard]] bool stuck(std::size_t i) const {
    return is_constant(unloaded_.sensels()[i]) && (far_above(i) || far_below(i));
  }

  [[nodiscard]] bool noisy(std::size_t i) const {
    return unloaded_.sensels()[i].deviation() > kNoisy * typical_.noise && typical_.noise > 0;
  }

  /// Whether it reads what one would that is pressed now and then, or always; or never, where its
  /// fellows are. A constant low reading is what a dead sensel gives.
  [[nodiscard]] bool as_if_touched(std::size_t i) const {
    const SenselStatistics& sensel = unloaded_.sensels()[i];
    return far_above(i) || noisy(i) || 2 * sensel.saturated > sensel.readings ||
           (far_below(i) && !is_constant(sensel));
  }

 private:
  [[nodiscard]] bool far_above(std::size_t i) const {
    return unloaded_.sensels()[i].mean > typical_.tare + kFar * typical_.spread;
  }
  [[nodiscard]] bool far_below(std::size_t i) const {
    return unloaded_.sensels()[i].mean < typical_.tare - kFar * typical_.spread;
  }

  const FrameStatistics& unloaded_;
  const Typical& typical_;
};

/// Faults of sensels come singly or in lines; contacts cover pillars.
void refuse_touched_skin(const FrameStatistics& unloaded, const std::vector<std::uint8_t>& mask,
                         const Judge& judge) {
  std::size_t touched = 0;
  std::string first;
  for_each_pillar(unloaded.skin(), [&](auto row, auto col, const auto& sensels) {
    int telling = 0;
    int standing_out = 0;
    for (const std::size_t i : sensels) {
      if ((!mask.empty() && mask[i] == 0) || unloaded.sensels()[i].readings == 0) continue;
      ++telling;
      standing_out += judge.as_if_touched(i) ? 1 : 0;
    }
    if (telling < kTellingSensels || standing_out < telling) return;
    if (touched++ == 0) first = fmt::format("row {}, column {}", row, col);
  });
  if (touched < kTouchedPillars) return;
  throw Error(
      unloaded.name(),
      fmt::format("{} pillars read as if something touched them, the first at {}", touched, first),
      "take it while nothing touches the skin, or say that it is preloaded");
}

/// Tare and noise of the good sensels; zero for the others.
void fill_planes(const FrameStatistics& unloaded, const FindingList& found, Calibration& planes) {
  const std::size_t sensels = unloaded.sensels().size();
  planes.tare.assign(sensels, 0);
  planes.noise.assign(sensels, 0);
  for (std::size_t i = 0; i < sensels; ++i) {
    if (!found.good(i)) continue;
    planes.tare[i] = static_cast<float>(unloaded.sensels()[i].mean);
    planes.noise[i] = static_cast<float>(noise_of(unloaded.sensels()[i], unloaded.type()));
  }
  planes.mask = found.mask_plane();
}

void require_majority(const FindingList& found, const FrameStatistics& unloaded) {
  const std::size_t sensels = unloaded.sensels().size();
  if (2 * found.findings().size() <= sensels) return;
  throw Error(unloaded.name(),
              fmt::format("{} of {} sensels cannot be right", found.findings().size(), sensels),
              "check the sensor and its full scale");
}

}  // namespace

TareResult take_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                     const TareOptions& options) {
  require_fitting(before, unloaded.skin(), unloaded.name());
  require_frames(unloaded, kLeastTareFrames);
  FindingList found(before.planes.mask, unloaded);
  mask_those_without_tare(unloaded, found);
  Typical typical = typical_of(unloaded, found);
  const Judge judge(unloaded, typical);
  if (!options.preloaded) refuse_touched_skin(unloaded, before.planes.mask, judge);
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    if (!found.good(i)) continue;
    if (judge.stuck(i)) {
      found.mask(i, SenselFault::stuck);
    } else if (judge.noisy(i)) {
      found.mask(i, SenselFault::noisy);
    }
  }
  require_majority(found, unloaded);
  TareResult result;
  result.calibration = before;
  fill_planes(unloaded, found, result.calibration.planes);
  set_threshold(result.calibration, options.threshold_factor);
  result.findings = found.findings();
  result.tare_counts = typical.tare;
  result.noise_counts = typical.noise;
  return result;
}

}  // namespace pillarfield
