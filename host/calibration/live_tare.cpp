#include "pillarfield/live_tare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/wire_correction.h"
#include "pillarfield/error.h"
#include "pillarfield/tare.h"

namespace pillarfield {
namespace {

/// Distance from the common change, in robust standard deviations of the changes.
constexpr double kFarChange = 6;
/// Least change that is noticed: in noises of a reading, and of whole counts.
constexpr double kLeastChangeNoises = 8;
constexpr double kLeastChangeCounts = 3;
/// Most by which unlike drift of the sensels may raise that.
constexpr double kUnlikeDrift = 4;

/// Rise of the readings since a tare before, without the change that all sensels have in common.
struct TareChange {
  TareChange(const FrameStatistics& unloaded, const std::vector<float>& before,
             const Calibration& now);

  double limit = 0;  ///< what noise and drift explain, counts
  double most = 0;   ///< counts
  std::size_t place = 0;
  std::uint64_t beyond = 0;  ///< sensels beyond the limit
};

TareChange::TareChange(const FrameStatistics& unloaded, const std::vector<float>& before,
                       const Calibration& now) {
  std::vector<double> changes;
  std::vector<double> noises;
  const auto change_of = [&](std::size_t i) {
    return unloaded.sensels()[i].mean - (before.empty() ? 0 : before[i]);
  };
  for (std::size_t i = 0; i < now.noise.size(); ++i) {
    if (!is_good(now, i)) continue;
    changes.push_back(change_of(i));
    noises.push_back(now.noise[i]);
  }
  const double common = median(changes);
  for (double& change : changes) change = std::abs(change - common);
  const double rounding = unloaded.type() == SenselType::f32 ? 0 : kLeastChangeCounts;
  const double least = std::max(kLeastChangeNoises * quantile(noises, 0.99), rounding);
  // The median deviation of a normal distribution is 0.6745 of its standard deviation.
  limit = std::max(kFarChange * 1.4826 * median(changes), least);
  if (!before.empty()) limit = std::min(limit, kUnlikeDrift * least);
  for (std::size_t i = 0; i < now.noise.size(); ++i) {
    const double change = is_good(now, i) ? change_of(i) - common : 0;
    beyond += change > limit ? 1 : 0;
    if (change > most) place = i;
    most = std::max(most, change);
  }
}

/// "a touch of less than 8.2 counts (0.026 N) on a sensel".
std::string light_touch(double counts, const SolverPlan& plan) {
  const bool is_linear = !plan.skin.power_law && plan.calibration.effects.curve.empty();
  return fmt::format(
      "a touch of less than {:.3g} counts{} on a sensel", counts,
      is_linear ? fmt::format(" ({:.2g} N)", counts / plan.skin.counts_per_newton) : "");
}

void refuse_touch(const TareChange& change, const SolverPlan& plan) {
  if (change.beyond == 0) return;
  throw Error(
      "tare",
      fmt::format("{} changed since the tare before by more than noise and drift explain, "
                  "most by {:.3g} counts at row {}, column {}; {} would not be seen",
                  counted(change.beyond, "sensel"), change.most, change.place / plan.skin.cols,
                  change.place % plan.skin.cols, light_touch(change.limit, plan)),
      "let go of the skin and take the tare again, or declare the skin preloaded");
}

}  // namespace

LiveTare::~LiveTare() = default;

LiveTare::LiveTare(SolverPlan plan, bool keeps_threshold)
    : given_(std::move(plan)), keeps_threshold_(keeps_threshold), found_(given_) {}

void LiveTare::start(std::chrono::nanoseconds duration, bool preloaded, std::vector<float> before) {
  duration_ = duration;
  preloaded_ = preloaded;
  before_ = before.empty() ? found_.calibration.tare : std::move(before);
  if (std::ranges::all_of(before_, [](float tare) { return tare == 0; })) before_.clear();
  correct_ =
      std::make_unique<WireCorrection>("tare", given_.skin, given_.sensel_type,
                                       given_.calibration.effects.wires, std::vector<float>());
  statistics_.emplace("tare", correct_->skin(), correct_->type());
  first_.reset();
}

const SolverPlan* LiveTare::add(const FrameView& frame, std::chrono::nanoseconds arrived) {
  constexpr int kMostFrames = 50;
  if (!statistics_) return nullptr;
  if (!first_) first_ = next_ = arrived;
  if (arrived >= next_) {
    statistics_->add((*correct_)(frame));
    next_ += duration_ / kMostFrames;
  }
  if (arrived - *first_ < duration_ || statistics_->frames() < kLeastTareFrames) return nullptr;
  return &finish();
}

const SolverPlan& LiveTare::finish() {
  const FrameStatistics unloaded = *std::exchange(statistics_, std::nullopt);
  SkinCalibration before = blank_calibration(given_.skin);
  before.planes = given_.calibration;
  before.counts_per_newton = given_.skin.counts_per_newton;
  before.power_law = given_.skin.power_law;
  // A tare before knows better than the other sensels how a sensel reads untouched.
  const TareResult tare =
      take_tare(before, unloaded, {.preloaded = preloaded_ || !before_.empty()});
  const TareChange change(unloaded, before_, tare.calibration.planes);
  if (!preloaded_ && !before_.empty()) refuse_touch(change, given_);
  found_ = given_;
  apply(tare.calibration, found_.skin, found_.calibration);
  if (keeps_threshold_) found_.skin.threshold_counts = given_.skin.threshold_counts;
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {  // for recordings without the mask
    if (!is_good(found_.calibration, i)) {
      found_.calibration.tare[i] = static_cast<float>(unloaded.sensels()[i].mean);
    }
  }
  note_ = fmt::format("readings above {:.3g} counts are usable, and {} would not have been seen",
                      found_.skin.threshold_counts, light_touch(change.limit, given_));
  if (!tare.findings.empty()) {
    note_ +=
        fmt::format("; {} read as faulty and are masked", counted(tare.findings.size(), "sensel"));
  }
  return found_;
}

}  // namespace pillarfield
