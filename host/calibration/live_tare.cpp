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

/// "a touch of less than 8.2 counts (0.026 N) on a sensel".
std::string light_touch(double counts, const SolverPlan& plan) {
  const bool is_linear = !plan.skin.power_law && plan.calibration.effects.curve.empty();
  return fmt::format(
      "a touch of less than {:.3g} counts{} on a sensel", counts,
      is_linear ? fmt::format(" ({:.2g} N)", counts / plan.skin.counts_per_newton) : "");
}

}  // namespace

LiveTare::~LiveTare() = default;

LiveTare::LiveTare(SolverPlan plan, bool keeps_threshold)
    : given_(std::move(plan)), keeps_threshold_(keeps_threshold), found_(given_) {
  if (!keeps_threshold && !given_.calibration.noise.empty()) {
    threshold_ = given_.skin.threshold_counts;
  }
}

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
    statistics_->add((*correct_)(frame), std::chrono::duration<double>(arrived - *first_).count());
    next_ += duration_ / kMostFrames;
  }
  if (arrived - *first_ < duration_ || statistics_->frames() < kLeastTareFrames) return nullptr;
  return &finish();
}

const SolverPlan& LiveTare::finish() {
  const TareFrames unloaded = *std::exchange(statistics_, std::nullopt);
  SkinCalibration before = blank_calibration(given_.skin);
  before.planes = given_.calibration;
  before.planes.tare = before_;
  before.planes.noise = found_.calibration.noise;
  before.counts_per_newton = given_.skin.counts_per_newton;
  before.power_law = given_.skin.power_law;
  before.threshold_counts = threshold_;
  before.threshold_factor = TareOptions{}.threshold_factor;
  const TareResult tare =
      take_tare(before, unloaded, {.preloaded = preloaded_, .otherwise = nullptr});
  threshold_ = tare.calibration.threshold_counts;
  found_ = given_;
  apply(tare.calibration, found_.skin, found_.calibration);
  if (keeps_threshold_) found_.skin.threshold_counts = given_.skin.threshold_counts;
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {  // for recordings without the mask
    if (!is_good(found_.calibration, i)) {
      found_.calibration.tare[i] = static_cast<float>(unloaded.sensels()[i].mean);
    }
  }
  note_ = fmt::format("readings above {:.3g} counts are usable, and {} would not have been seen",
                      found_.skin.threshold_counts, light_touch(tare.unseen_counts, given_));
  if (!tare.findings.empty()) {
    note_ +=
        fmt::format("; {} read as faulty and are masked", counted(tare.findings.size(), "sensel"));
  }
  return found_;
}

}  // namespace pillarfield
