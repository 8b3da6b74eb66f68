#include "pipeline/line_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "pillarfield/calibration.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kWatchedSensels = std::uint64_t{1} << 24U;
/// Load that tells, in thresholds and in the largest of its frame.
constexpr float kTellingThresholds = 3;
constexpr float kTellingShare = 0.15F;

}  // namespace

LineCheck::LineCheck(const SolverPlan& plan)
    : plan_(plan), watch_(plan.skin.rows, plan.skin.cols, plan.skin.has_pillars() ? 2 : 1) {}

void LineCheck::add(const FrameView& readings) {
  const Calibration& planes = plan_.calibration;
  if (planes.tare.empty() && !(plan_.skin.threshold_counts > 0)) return;
  const std::uint64_t sensels = std::uint64_t{readings.rows} * readings.cols;
  if (++frames_ * sensels > kWatchedSensels && frames_ % 64 != 0) return;
  signals_.clear();
  float peak = 0;
  for_each_row(readings, [&](std::size_t, const auto* row) {
    for (std::size_t col = 0; col < readings.cols; ++col) {
      const std::size_t i = signals_.size();
      const float beyond =
          static_cast<float>(row[col]) - (planes.tare.empty() ? 0 : planes.tare[i]);
      const float signal = beyond * (planes.gain.empty() ? 1 : planes.gain[i]);
      signals_.push_back(is_good(planes, i) ? signal : std::numeric_limits<float>::quiet_NaN());
      peak = std::max(peak, signals_.back());
    }
  });
  const auto threshold = static_cast<float>(plan_.skin.threshold_counts);
  least_.assign(signals_.size(), std::max(kTellingThresholds * threshold, kTellingShare * peak));
  watch_.add(signals_, least_);
}

std::vector<std::string> LineCheck::warnings() const {
  std::vector<std::string> sentences;
  for (const LineAxis axis : {LineAxis::rows, LineAxis::columns}) {
    const std::vector<std::uint32_t> dead = watch_.dead_lines(axis);
    if (dead.empty()) continue;
    sentences.push_back(
        fmt::format("Dead: {} {} not respond while those on both sides do, so that forces there "
                    "are missing and bounds of friction are wrong; mask with 'pillarfield "
                    "calibrate faults' (in Python pf.calibrate.faults).",
                    axis == LineAxis::rows ? (dead.size() > 1 ? "rows" : "row")
                                           : (dead.size() > 1 ? "columns" : "column"),
                    fmt::format("{} {}", fmt::join(dead, ", "), dead.size() > 1 ? "do" : "does")));
  }
  return sentences;
}

}  // namespace pillarfield
