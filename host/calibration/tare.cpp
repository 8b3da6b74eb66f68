#include "pillarfield/tare.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/number_text.h"
#include "calibration/finding_list.h"
#include "calibration/sensel_judge.h"
#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// Least number of outlying pillars, each of at least kTestedSensels sensels, for which the skin
/// counts as touched.
constexpr std::size_t kTouchedPillars = 2;
constexpr int kTestedSensels = 3;

/// True if the sensel reads as if it were touched, or as if most others were and it were not. A
/// constant low reading is that of a dead sensel.
bool is_as_if_touched(const SenselJudge& judge, std::size_t i) {
  const SenselEvidence& sensel = judge.sensels()[i];
  const auto verdict = judge.verdict(i);
  return verdict != SenselFault::absent &&
         (judge.is_far_above(i) || verdict == SenselFault::noisy || is_saturated(sensel.read) ||
          (judge.is_far_below(i) && !sensel.is_constant()));
}

/// A board that has stopped repeats one frame.
void refuse_equal_frames(const FrameStatistics& unloaded) {
  const auto moves = [](const SenselStatistics& read) { return read.lowest < read.highest; };
  if (std::ranges::any_of(unloaded.sensels(), moves)) return;
  throw Error(unloaded.name(),
              fmt::format("all of its {} frames are equal, as of a board that has stopped",
                          unloaded.frames()),
              "record frames with the noise of the sensor");
}

/// Throws if whole pillars are outliers: faults are single sensels or lines, contacts cover
/// pillars.
void refuse_touched_skin(const FrameStatistics& unloaded, const std::vector<std::uint8_t>& mask,
                         const SenselJudge& judge) {
  const std::uint32_t side = unloaded.skin().has_pillars() ? 1 : 2;  // in elements
  std::size_t touched = 0;
  std::string first;
  for_each_pillar(unloaded.skin(), [&](auto row, auto col, const auto& sensels) {
    int tested = 0;
    int standing_out = 0;
    for (const std::size_t i : sensels) {
      if ((!mask.empty() && mask[i] != kGood) || unloaded.sensels()[i].readings == 0) continue;
      ++tested;
      standing_out += is_as_if_touched(judge, i) ? 1 : 0;
    }
    if (tested < kTestedSensels || standing_out < tested) return;
    if (touched++ == 0) first = fmt::format("row {}, column {}", side * row, side * col);
  });
  if (touched < kTouchedPillars) return;
  throw Error(
      unloaded.name(),
      fmt::format("{} {} read as if something touched them, the first at {}",
                  std::size_t{side} * side * touched, name_of(unloaded.skin().layout), first),
      "record while nothing touches the skin, or declare the skin preloaded");
}

/// Fills tare and noise; zero for masked sensels.
void fill_planes(const SenselJudge& judge, const FindingList& found, Calibration& planes) {
  const std::size_t sensels = judge.sensels().size();
  planes.tare.assign(sensels, 0);
  planes.noise.assign(sensels, 0);
  for (std::size_t i = 0; i < sensels; ++i) {
    if (!found.good(i)) continue;
    planes.tare[i] = static_cast<float>(judge.sensels()[i].level);
    planes.noise[i] = static_cast<float>(judge.sensels()[i].noise);
  }
  planes.mask = found.mask_plane();
}

void require_majority(const FindingList& found, const FrameStatistics& unloaded) {
  const auto is_absent = [](const SenselFinding& each) {
    return each.fault == SenselFault::absent;
  };
  const auto absent = static_cast<std::size_t>(std::ranges::count_if(found.findings(), is_absent));
  const std::size_t sensels = unloaded.sensels().size() - absent;
  const std::size_t faulty = found.findings().size() - absent;
  if (2 * faulty <= sensels) return;
  throw Error(unloaded.name(), fmt::format("{} of {} sensels are faulty", faulty, sensels),
              "check the sensor and its full scale");
}

}  // namespace

TareResult take_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                     const TareOptions& options) {
  require_fitting(before, unloaded.skin(), unloaded.name());
  require_frames(unloaded, kLeastTareFrames);
  FindingList found(before.planes.mask, unloaded);
  const SenselJudge judge(evidence_without_load(unloaded), unloaded.frames(), before.planes.mask);
  if (judge.typical().count == 0) {
    throw Error(unloaded.name(), "no sensel has a valid tare",
                "check the sensor, its full scale and its mask");
  }
  if (!options.preloaded) refuse_touched_skin(unloaded, before.planes.mask, judge);
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    if (!found.good(i)) continue;
    if (const auto fault = judge.verdict(i)) found.mask(i, *fault);
  }
  require_majority(found, unloaded);
  TareResult result;
  result.calibration = before;
  fill_planes(judge, found, result.calibration.planes);
  set_threshold(result.calibration, options.threshold_factor);
  result.findings = found.findings();
  result.tare_counts = judge.typical().level;
  result.noise_counts = judge.typical().noise;
  return result;
}

namespace {

SkinCalibration run_tare(StepWork& work) {
  const TareOptions options = {.threshold_factor = work.number("threshold-factor", 4),
                               .preloaded = work.number("preloaded", 0) != 0};
  const FrameStatistics unloaded = work.statistics(WireUse::unloaded).front();
  refuse_equal_frames(unloaded);
  const TareResult result = take_tare(work.before, unloaded, options);
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
