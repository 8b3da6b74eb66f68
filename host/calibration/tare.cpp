#include "pillarfield/tare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/finding_list.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// Distance from the median tare, in spreads, beyond which a tare is an outlier.
constexpr double kFar = 6;
/// Multiple of the median noise above which a sensel is noisy.
constexpr double kNoisy = 10;
/// Least number of outlying pillars, each of at least kTestedSensels sensels, for which the skin
/// counts as touched.
constexpr std::size_t kTouchedPillars = 2;
constexpr int kTestedSensels = 3;

/// Medians over sensels with a tare.
struct Typical {
  double tare = 0;
  double spread = 0;  ///< robust standard deviation of the tares
  double noise = 0;
};

/// Least standard deviation of a reading: that of rounding to whole counts.
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
    throw Error(unloaded.name(), "no sensel has a valid tare",
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

void mask_without_tare(const FrameStatistics& unloaded, FindingList& found) {
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

/// Tests sensels against the medians of the skin.
class OutlierTest {
 public:
  OutlierTest(const FrameStatistics& unloaded, const Typical& typical)
      : unloaded_(unloaded), typical_(typical) {}

  [[nodiscard]] bool stuck(std::size_t i) const {
    return is_constant(unloaded_.sensels()[i]) && (far_above(i) || far_below(i));
  }

  [[nodiscard]] bool noisy(std::size_t i) const {
    return unloaded_.sensels()[i].deviation() > kNoisy * typical_.noise && typical_.noise > 0;
  }

  /// Whether the sensel reads as if it were touched, or as if most others were and it were not. A
  /// constant low reading is that of a dead sensel.
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

/// Throws if whole pillars are outliers: faults are single sensels or lines, contacts cover
/// pillars.
void refuse_touched_skin(const FrameStatistics& unloaded, const std::vector<std::uint8_t>& mask,
                         const OutlierTest& test) {
  const std::uint32_t side = unloaded.skin().has_pillars() ? 1 : 2;  // in elements
  std::size_t touched = 0;
  std::string first;
  for_each_pillar(unloaded.skin(), [&](auto row, auto col, const auto& sensels) {
    int tested = 0;
    int standing_out = 0;
    for (const std::size_t i : sensels) {
      if ((!mask.empty() && mask[i] != kGood) || unloaded.sensels()[i].readings == 0) continue;
      ++tested;
      standing_out += test.as_if_touched(i) ? 1 : 0;
    }
    if (tested < kTestedSensels || standing_out < tested) return;
    if (touched++ == 0) first = fmt::format("row {}, column {}", side * row, side * col);
  });
  if (touched < kTouchedPillars) return;
  throw Error(unloaded.name(),
              fmt::format("{} {} read as if something touched them, the first at {}",
                          side * side * touched, name_of(unloaded.skin().layout), first),
              "record while nothing touches the skin, or declare the skin preloaded");
}

/// Fills tare and noise; zero for masked sensels.
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
              fmt::format("{} of {} sensels are faulty", found.findings().size(), sensels),
              "check the sensor and its full scale");
}

}  // namespace

TareResult take_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                     const TareOptions& options) {
  require_fitting(before, unloaded.skin(), unloaded.name());
  require_frames(unloaded, kLeastTareFrames);
  FindingList found(before.planes.mask, unloaded);
  mask_without_tare(unloaded, found);
  Typical typical = typical_of(unloaded, found);
  const OutlierTest test(unloaded, typical);
  if (!options.preloaded) refuse_touched_skin(unloaded, before.planes.mask, test);
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    if (!found.good(i)) continue;
    if (test.stuck(i)) {
      found.mask(i, SenselFault::stuck);
    } else if (test.noisy(i)) {
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

namespace {

SkinCalibration run_tare(StepWork& work) {
  const TareOptions options = {.threshold_factor = work.number("threshold-factor", 4),
                               .preloaded = work.number("preloaded", 0) != 0};
  const TareResult result =
      take_tare(work.before, work.statistics(WireUse::unloaded).front(), options);
  const SkinCalibration& calibration = result.calibration;
  StepReport& report = work.report;
  report.headline = fmt::format("Tare of {} x {} sensels from {}", calibration.rows,
                                calibration.cols, counted(work.frames(), "frame"));
  report.measure("tare_counts", result.tare_counts, "tare", "counts, median of the valid sensels");
  report.measure("noise_counts", result.noise_counts, "noise",
                 "counts, median of the valid sensels");
  report.measure("untouched_share", untouched_share(calibration), "untouched",
                 "% of the untouched skin would have a status");
  report.measure(
      "threshold_counts", *calibration.threshold_counts, "threshold",
      fmt::format("counts, {:g} times the 99th percentile of the noise", options.threshold_factor));
  report.add(calibration, result.findings);
  work.parameters = fmt::format("threshold_factor = {}, preloaded = {}", options.threshold_factor,
                                options.preloaded);
  return calibration;
}

}  // namespace

StepKind tare_step() {
  StepKind step = {"tare", "Tare, noise and threshold from frames of the unloaded skin.",
                   "UNLOADED", "Frames in which nothing touches the skin", run_tare};
  step.is_single = true;
  step.before = StepKind::Before::optional;
  step.before_help = "Calibration whose tare is replaced [none]";
  step.arguments = {
      StepArgument::number("threshold-factor", "RATIO",
                           "Threshold as a multiple of the noise of a reading [4]",
                           {0, kMaxThresholdFactor}),
      StepArgument::flag("preloaded",
                         "Accept readings that resemble a touch, as of a bent or covered skin")};
  step.examples = {kSimulateIdle, kTareIdle,
                   "calibrate tare idle.h5 -o strict.h5 --threshold-factor 6"};
  return step;
}

}  // namespace pillarfield
