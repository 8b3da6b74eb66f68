#include "pillarfield/fault_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "calibration/finding_list.h"
#include "calibration/sensel_judge.h"
#include "calibration/steps.h"
#include "lanes/lane_solver.h"
#include "pillarfield/doctor.h"
#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "skin/pillar_sensels.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

/// Deviation of a changing prediction, in that of three readings' noise.
constexpr double kMovingFactor = 5;

/// The other three sensels of a pillar, for each sensel: two neighbours and the opposite one.
struct Others {
  std::size_t neighbour;
  std::size_t other_neighbour;
  std::size_t opposite;
};
constexpr std::array<Others, 4> kOthers = {{{1, 3, 2}, {0, 2, 3}, {1, 3, 0}, {0, 2, 1}}};

/// A plan whose force on each sensel is its corrected reading, counts; zero where
/// that is not usable.
SolverPlan plan_of_sensels(SolverPlan plan) {
  Skin& skin = plan.skin;
  Calibration& planes = plan.calibration;
  for (auto* const plane : {&planes.bend_x, &planes.bend_y, &planes.bend_xy}) plane->clear();
  planes.effects = without_pillars(std::move(planes.effects));
  if (planes.mask.empty()) planes.mask.assign(skin.sensels(), kGood);
  for (std::size_t i = 0; skin.has_pillars() && i < planes.mask.size(); ++i) {
    const bool is_under_one =
        i / skin.cols / 2 < skin.pillar_rows() && i % skin.cols / 2 < skin.pillar_cols();
    if (!is_under_one) planes.mask[i] = kAbsent;
  }
  skin.layout = SkinLayout::sensels;
  skin.counts_per_newton = 1;
  return plan;
}

[[noreturn]] void refuse_still(const FrameStatistics& statistics) {
  throw Error(statistics.name(),
              fmt::format("no sensel moved in its {} frames", statistics.frames()),
              "record while pressing all over the skin, for example with a rolling ball");
}

}  // namespace

FaultFinder::FaultFinder(std::string name, const Skin& skin, SenselType type,
                         const SkinCalibration& calibration, std::uint32_t least_frames)
    : statistics_(std::move(name), skin, type),
      calibration_(calibration),
      least_frames_(least_frames),
      predictions_(skin.sensels()) {
  require_fitting(calibration, skin, statistics_.name());
  plan_.skin = skin;
  plan_.sensel_type = type;
  apply(calibration, plan_.skin, plan_.calibration);
  plan_.calibration.effects.wires.reset();  // The frames are without their crosstalk.
  sensels_ = plan_of_sensels(plan_);
}

void FaultFinder::add(const FrameView& frame) {
  statistics_.add(frame);
  const ForceField corrected = solve_in_lanes(sensels_, frame);
  for_each_pillar(plan_.skin,
                  [&](auto, auto, const auto& sensels) { predict(sensels, corrected); });
}

void FaultFinder::predict(const std::array<std::size_t, 4>& sensels, const ForceField& corrected) {
  const auto is_usable = [&](std::size_t i) {
    return (corrected.status[i] & status::kSensel1) != 0;
  };
  for (std::size_t n = 0; n < sensels.size(); ++n) {
    Prediction& prediction = predictions_[sensels.at(n)];
    if (is_usable(sensels.at(n))) ++prediction.usable;
    const std::size_t p = sensels.at(kOthers.at(n).neighbour);
    const std::size_t q = sensels.at(kOthers.at(n).other_neighbour);
    const std::size_t r = sensels.at(kOthers.at(n).opposite);
    if (!is_usable(p) || !is_usable(q) || !is_usable(r)) continue;
    const std::vector<float>& counts = corrected.normal;
    const Range range = range_of(sensels.at(n));
    const double left =
        std::clamp(double{counts[p]} + counts[q] - counts[r], range.least, range.most);
    ++prediction.frames;
    const double step = left - prediction.mean;
    prediction.mean += step / prediction.frames;
    prediction.squares += step * (left - prediction.mean);
  }
}

/// Range of V that a sensel can show: from threshold plus dead zone to full scale.
FaultFinder::Range FaultFinder::range_of(std::size_t sensel) const {
  const Skin& skin = plan_.skin;
  const Calibration& planes = plan_.calibration;
  const double dead_zone = planes.dead_zone.empty() ? 0 : planes.dead_zone[sensel];
  const double least = skin.threshold_counts + dead_zone;
  if (!skin.full_scale_counts) return {least, std::numeric_limits<double>::infinity()};
  const double tare = planes.tare.empty() ? 0 : planes.tare[sensel];
  const double gain = planes.gain.empty() ? 1 : planes.gain[sensel];
  const double corrected = std::max(0.0, (*skin.full_scale_counts - tare) * gain);
  const double most = skin.power_law ? straightened(*skin.power_law, corrected)
                                     : load_at(planes.effects.curve, corrected);
  return {least, std::max(least, most + dead_zone)};
}

/// Classifies sensels, pillar by pillar, from the statistics of all frames.
class FaultFinder::Classifier {
 public:
  Classifier(const FaultFinder& finder, FindingList& found, FaultResult& result)
      : finder_(finder), found_(found), result_(result) {}

  void classify(const std::array<std::size_t, 4>& sensels) {
    for (const std::size_t i : sensels) {
      if (found_.good(i) && is_uninformative(i)) found_.mask(i, SenselFault::not_a_number);
    }
    std::array<bool, 4> moves{};
    std::uint32_t loaded_frames = 0;
    for (std::size_t n = 0; n < sensels.size(); ++n) {
      moves.at(n) = found_.good(sensels.at(n)) && !is_still(sensels.at(n));
      if (moves.at(n)) {
        loaded_frames = std::max(loaded_frames, finder_.predictions_[sensels.at(n)].usable);
      }
    }
    const bool loaded = loaded_frames >= finder_.least_frames_;
    const auto moving = std::count(moves.begin(), moves.end(), true);
    moving_ += static_cast<std::size_t>(moving);
    for (std::size_t n = 0; n < sensels.size(); ++n) {
      if (!moves.at(n) && found_.good(sensels.at(n))) classify_still(sensels.at(n), loaded, moving);
    }
  }

  /// Number of moving sensels in the pillars classified so far.
  [[nodiscard]] std::size_t moving() const { return moving_; }

 private:
  /// Classifies a still sensel; `moving` is the number of moving sensels of its pillar.
  void classify_still(std::size_t sensel, bool loaded, std::ptrdiff_t moving) {
    if (moving == 3 && should_move(sensel)) {
      found_.mask(sensel, fault_of(sensel));
    } else if (moving < 3 && loaded) {
      found_.suspect(sensel, SenselFault::unknown);
    } else {
      const std::uint32_t cols = finder_.plan_.skin.cols;
      result_.untested.emplace_back(static_cast<std::uint32_t>(sensel / cols),
                                    static_cast<std::uint32_t>(sensel % cols));
    }
  }

  [[nodiscard]] const SenselStatistics& read(std::size_t sensel) const {
    return finder_.statistics_.sensels()[sensel];
  }

  [[nodiscard]] bool is_uninformative(std::size_t sensel) const {
    return lacks_readings(read(sensel), finder_.statistics_.frames());
  }

  /// Noise of a raw reading, counts.
  [[nodiscard]] double noise(std::size_t sensel) const {
    const Calibration& planes = finder_.plan_.calibration;
    return planes.noise.empty() ? reading_noise(finder_.plan_) : planes.noise[sensel];
  }

  [[nodiscard]] bool is_still(std::size_t sensel) const {
    return pillarfield::is_still(read(sensel), noise(sensel));
  }

  /// True if the prediction of parity moves by more than the noise of three readings.
  [[nodiscard]] bool should_move(std::size_t sensel) const {
    const Prediction& prediction = finder_.predictions_[sensel];
    if (prediction.frames < std::max(2U, finder_.least_frames_)) return false;
    const Calibration& planes = finder_.plan_.calibration;
    const double gain = planes.gain.empty() ? 1 : planes.gain[sensel];
    const double deviation = std::sqrt(prediction.squares / (prediction.frames - 1));
    return deviation > 0 && deviation >= kMovingFactor * std::sqrt(3.0) * gain * noise(sensel);
  }

  [[nodiscard]] SenselFault fault_of(std::size_t sensel) const {
    if (is_saturated(read(sensel))) return SenselFault::saturated;
    const bool responds = 2 * finder_.predictions_[sensel].usable > finder_.statistics_.frames();
    return responds ? SenselFault::stuck : SenselFault::unresponsive;
  }

  const FaultFinder& finder_;
  FindingList& found_;
  FaultResult& result_;
  std::size_t moving_ = 0;
};

FaultResult FaultFinder::result() const {
  require_frames(statistics_, least_frames_);
  FaultResult result;
  FindingList found(plan_.calibration.mask, statistics_);
  Classifier classifier(*this, found, result);
  for_each_pillar(plan_.skin,
                  [&](auto, auto, const auto& sensels) { classifier.classify(sensels); });
  if (classifier.moving() == 0) refuse_still(statistics_);
  result.calibration = calibration_;
  result.calibration.planes.mask = found.mask_plane();
  result.findings = found.findings();
  result.frames = statistics_.frames();
  return result;
}

namespace {

FaultResult faults_by_parity(const StepWork& work, std::uint32_t least_frames) {
  const StepFrames& first = work.files.front();
  const WireCorrection correct = work.correction(first, WireUse::loaded);
  FaultFinder finder(first.name(), correct.skin(), correct.type(), work.before, least_frames);
  for (const StepFrames& file : work.files) {
    work.for_each(file, [&](const FrameView& frame, double) { finder.add(frame); });
  }
  return finder.result();
}

/// Without pillars there is no parity: masks what the doctor finds.
FaultResult faults_by_neighbours(const StepWork& work, std::uint32_t least_frames) {
  const StepFrames& first = work.files.front();
  const WireCorrection correct = work.correction(first, WireUse::loaded);
  Doctor doctor(first.name(), correct.skin(), correct.type());
  FrameStatistics statistics(first.name(), correct.skin(), correct.type());
  for (const StepFrames& file : work.files) {
    work.for_each(file, [&](const FrameView& frame, double) {
      statistics.add(frame);
      doctor.add(frame, std::numeric_limits<double>::quiet_NaN());
    });
  }
  require_frames(statistics, least_frames);
  const Diagnosis seen = doctor.result();
  if (seen.contact_frames == 0) refuse_still(statistics);
  FindingList found(work.before.planes.mask, statistics);
  for (std::size_t sensel = 0; sensel < seen.verdicts.size(); ++sensel) {
    if (seen.verdicts[sensel] && found.good(sensel)) found.mask(sensel, *seen.verdicts[sensel]);
  }
  FaultResult result = {work.before, found.findings(), seen.untouched, statistics.frames()};
  result.calibration.planes.mask = found.mask_plane();
  return result;
}

SkinCalibration run_faults(StepWork& work) {
  const auto least_frames =
      static_cast<std::uint32_t>(work.number("min-frames", kLeastFaultFrames));
  const bool has_pillars = work.files.front().skin.has_pillars();
  const FaultResult result =
      has_pillars ? faults_by_parity(work, least_frames) : faults_by_neighbours(work, least_frames);
  const SkinCalibration& calibration = result.calibration;
  const std::size_t sensels = std::size_t{calibration.rows} * calibration.cols;
  StepReport& report = work.report;
  report.headline = fmt::format("Tested {} x {} sensels with {}", calibration.rows,
                                calibration.cols, counted(result.frames, "frame"));
  report.add(calibration, result.findings);
  report.facts["untested"] = result.untested;
  report.notes.push_back(fmt::format("Untested: {} of {} sensels, never {}; --json lists them",
                                     grouped(result.untested.size()), grouped(sensels),
                                     has_pillars ? "predicted to change" : "touched"));
  work.parameters = fmt::format("least_frames = {}", least_frames);
  return calibration;
}

}  // namespace

StepKind faults_step() {
  StepKind step = {"faults",
                   "Find dead, stuck and saturated sensels by parity, or without pillars by their "
                   "neighbours, and mask them.",
                   "FRAMES", "Frames in which all of the skin is pressed", run_faults};
  step.arguments = {StepArgument::whole(
      "min-frames",
      "Smallest number of frames, and of those in which parity predicts a sensel [30]", {2, 1e9})};
  step.examples = {kSimulateIdle,
                   "simulate scenes/calibration/new_skin_rolled.toml --uncalibrated -o rolled.h5",
                   kTareIdle, "calibrate faults rolled.h5 --calibration tared.h5 -o tested.h5"};
  return step;
}

}  // namespace pillarfield
