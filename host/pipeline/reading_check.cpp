#include "pillarfield/reading_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/calibration.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr double kNearlyAll = 0.95;
constexpr double kHardlyAny = 0.01;

float reading_at(const FrameView& readings, std::size_t index) {
  if (readings.type == SenselType::u8)
    return static_cast<const std::uint8_t*>(readings.data)[index];
  if (readings.type == SenselType::u16) {
    return static_cast<const std::uint16_t*>(readings.data)[index];
  }
  return static_cast<const float*>(readings.data)[index];
}

/// Standard deviation of a reading, counts, if the plan states one, else zero.
double stated_noise(const SolverPlan& plan) {
  const bool is_stated = plan.noise_counts || !plan.calibration.noise.empty();
  return is_stated ? reading_noise_n(plan) * plan.skin.counts_per_newton : 0;
}

}  // namespace

std::uint64_t count_in_contact(std::span<const std::uint8_t> status) {
  return static_cast<std::uint64_t>(std::ranges::count_if(
      status, [](std::uint8_t bits) { return (bits & status::kUsable) != 0; }));
}

std::string coverage_words(double share, bool has_tare, SkinLayout layout) {
  return fmt::format("{:.1f} % of all {} are in contact{}", 100 * share, name_of(layout),
                     has_tare
                         ? ": a load covers the array, or its tare has drifted. Take it anew "
                           "while nothing touches it, or let it follow with --follow-baseline (in "
                           "Python baseline_time_s=)."
                         : " and there is no tare; measure one with 'pillarfield calibrate tare', "
                           "in frames without load with --tare-frames (in Python tare_frames=), "
                           "or live with --tare or the viewer's key Z.");
}

ReadingCheck::ReadingCheck(const SolverPlan& plan)
    : plan_(plan),
      present_(plan.skin.elements() - count_absent_elements(plan.calibration, plan.skin)),
      noise_(plan.skin.has_pillars() ? stated_noise(plan) : 0),
      parity_unit_(plan.sensel_type == SenselType::f32 ? noise_ / 4 : 1) {}

void ReadingCheck::append(const SolvedFrame& frame) {
  const std::uint64_t touched = count_in_contact(frame.forces.status);
  std::uint64_t faulty = 0;
  for (const std::uint8_t status : frame.forces.status) {
    faulty += (status & status::kInconsistent) != 0 ? 1 : 0;
  }
  ++frames_;
  in_contact_ += touched;
  if (touched == 0 && faulty == present_ && present_ > 0) ++blank_frames_;
  const bool is_nearly_idle =
      static_cast<double>(touched) <= kHardlyAny * static_cast<double>(present_);
  if (is_nearly_idle && frame.readings.data != nullptr) look_at(frame.readings);
  if (noise_ > 0 && frame.readings.data != nullptr) compare_with_earlier(frame.readings);
}

/// Counts the changes of parity, V1 + V3 - V2 - V4, of pillars whose load stayed: its noise alone,
/// since gains, tares and loads cancel. The three other sums of the four changes, each with the
/// noise of the parity and independent of it, tell the load.
void ReadingCheck::compare_with_earlier(const FrameView& readings) {
  constexpr std::uint64_t kMostPillars = 2048;  // of a frame
  constexpr double kSteady = 16;                // largest change of a sum, deviations of a reading
  constexpr double kInside = 4;                 // distance from the ends of the range, likewise
  const std::uint64_t pillars = plan_.skin.elements();
  const std::uint64_t step = (pillars + kMostPillars - 1) / kMostPillars;
  const bool is_first = earlier_.empty();
  earlier_.resize((pillars + step - 1) / step);
  const auto least = static_cast<float>(kInside * noise_);
  const auto most = static_cast<float>(plan_.skin.full_scale_counts.value_or(1e30)) - least;
  for (std::size_t i = 0; i < earlier_.size(); ++i) {
    const std::uint64_t row = i * step / plan_.skin.pillar_cols();
    const std::uint64_t col = i * step % plan_.skin.pillar_cols();
    std::array<float, 4> now{};
    std::array<float, 4> change{};
    bool usable = !is_first;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const std::uint64_t at_row = 2 * row + k / 2;
      const std::uint64_t at_col = 2 * col + k % 2;
      now[k] = reading_at(readings, at_row * readings.row_stride + at_col);
      change[k] = now[k] - earlier_[i][k];
      usable = usable && is_good(plan_.calibration, at_row * readings.cols + at_col) &&
               std::min(now[k], earlier_[i][k]) > least && std::max(now[k], earlier_[i][k]) < most;
    }
    earlier_[i] = now;
    const auto [a, b, c, d] = change;
    const float moved =
        std::max({std::abs(a + b + c + d), std::abs(a + b - c - d), std::abs(a - b + c - d)});
    if (!usable || !(moved <= kSteady * noise_)) continue;  // NaN too
    const double units = std::abs(a - b - c + d) / parity_unit_;
    const auto last = static_cast<double>(parity_changes_.size() - 1);
    ++parity_changes_[static_cast<std::size_t>(std::round(std::min(units, last)))];
  }
}

/// Standard deviation of a reading by the median of the changes; unset if it is not clearly larger
/// than stated.
std::optional<double> ReadingCheck::measured_noise() const {
  constexpr std::uint64_t kFewChanges = 500;
  constexpr double kClearly = 1.4;
  constexpr double kMedian = 0.6745;  // of the magnitude, deviations
  std::uint64_t changes = 0;
  for (const std::uint64_t count : parity_changes_) changes += count;
  if (changes < kFewChanges) return std::nullopt;
  double before = 0;
  std::size_t bin = 0;
  const double half = 0.5 * static_cast<double>(changes);
  while (before + static_cast<double>(parity_changes_[bin]) < half) {
    before += static_cast<double>(parity_changes_[bin++]);
  }
  const double low = bin == 0 ? 0 : static_cast<double>(bin) - 0.5;
  const double high = static_cast<double>(bin) + 0.5;
  const double median =
      low + (high - low) * (half - before) / static_cast<double>(parity_changes_[bin]);
  const double noise = median * parity_unit_ / (kMedian * std::sqrt(8.0));
  return noise > kClearly * noise_ ? std::optional(noise) : std::nullopt;
}

void ReadingCheck::look_at(const FrameView& readings) {
  constexpr std::uint64_t kMostSensels = std::uint64_t{1} << 26U;  // then in 1 of 64 frames
  if (sensels_seen_ > kMostSensels && frames_ % 64 != 0) return;
  sensels_seen_ += std::uint64_t{readings.rows} * readings.cols;
  const Counts counts = readings.type == SenselType::u8    ? count<std::uint8_t>(readings)
                        : readings.type == SenselType::u16 ? count<std::uint16_t>(readings)
                                                           : count<float>(readings);
  sunken_frames_ +=
      static_cast<double>(counts.below) > kNearlyAll * static_cast<double>(counts.good) ? 1 : 0;
  most_.above = std::max(most_.above, counts.above);
  most_.below = std::max(most_.below, counts.below);
  most_.highest = std::max(most_.highest, counts.highest);
  most_.lowest = std::min(most_.lowest, counts.lowest);
}

template <class Reading>
ReadingCheck::Counts ReadingCheck::count(const FrameView& readings) const {
  const auto threshold = static_cast<float>(plan_.skin.threshold_counts);
  const std::vector<float>& tare = plan_.calibration.tare;
  Counts counts;
  for (std::uint32_t row = 0; row < readings.rows; ++row) {
    const auto* const line = static_cast<const Reading*>(readings.data) + row * readings.row_stride;
    for (std::uint32_t col = 0; col < readings.cols; ++col) {
      const std::size_t sensel = std::size_t{row} * readings.cols + col;
      if (!is_good(plan_.calibration, sensel)) continue;
      const float change = static_cast<float>(line[col]) - (tare.empty() ? 0 : tare[sensel]);
      ++counts.good;
      counts.above += change > threshold ? 1 : 0;
      counts.below += change < -threshold ? 1 : 0;
      counts.highest = change > counts.highest ? change : counts.highest;
      counts.lowest = change < counts.lowest ? change : counts.lowest;
    }
  }
  return counts;
}

std::vector<std::string> ReadingCheck::warnings() const {
  std::vector<std::string> sentences;
  const double all = static_cast<double>(frames_) * static_cast<double>(present_);
  if (!(all > 0)) return sentences;
  const double share = static_cast<double>(in_contact_) / all;
  if (blank_frames_ > 0) {
    sentences.push_back(
        fmt::format("In {} of {} frames no sensel has a reading (NaN or infinite); their forces "
                    "are zero, with the status "
                    "of missing sensels.",
                    blank_frames_, frames_));
  }
  if (sunken_frames_ > 0) {
    sentences.push_back(fmt::format(
        "In {} of {} frames nearly all sensels read less than their tare by more than the "
        "threshold, as in lost frames of zeros: that no load shows in them is no release. "
        "'pillarfield doctor' counts lost and repeated frames.",
        sunken_frames_, frames_));
  }
  if (const std::optional<double> noise = measured_noise()) {
    const double rounding = plan_.sensel_type == SenselType::f32 ? 0 : 1.0 / 12;
    const auto alone = [&](double sigma) {
      return std::sqrt(std::max(sigma * sigma - rounding, 0.0));
    };
    sentences.push_back(fmt::format(
        "The readings' noise is about {:.2g} counts, and {:.3g} is stated: deviations and "
        "intervals are too narrow. Give --noise {:.2g} (in Python noise_counts=), or take the tare "
        "again.",
        alone(*noise), alone(noise_), alone(*noise)));
  }
  if (share >= kCovered) {
    sentences.push_back(coverage_words(share, !plan_.calibration.tare.empty(), plan_.skin.layout));
  }
  if (share <= kHardlyAny && blank_frames_ < frames_) warn_of_no_contact(sentences);
  return sentences;
}

void ReadingCheck::warn_of_no_contact(std::vector<std::string>& sentences) const {
  constexpr std::uint64_t kFewSensels = 4;
  if (most_.below >= kFewSensels && most_.below > 3 * most_.above) {
    sentences.push_back(fmt::format(
        "Readings fall: {} sensels of a frame read less than their tare by more than the "
        "threshold, "
        "down to {:.4g} counts below it, and at most {} read more. Give --falling (in Python the "
        "full "
        "scale minus the reading) if they fall under load.",
        most_.below, -most_.lowest, most_.above));
  } else if (in_contact_ == 0) {
    sentences.push_back(fmt::format(
        "No {} is in contact in any of {} frames: readings rise to at most {:.4g} counts{}, "
        "and those "
        "above the threshold of {:.4g} are usable; give a lower --threshold (in Python "
        "threshold_counts=), or a tare of the unloaded skin.",
        plan_.skin.has_pillars() ? "pillar" : "sensel", frames_, most_.highest,
        plan_.calibration.tare.empty() ? "" : " above their tare", plan_.skin.threshold_counts));
  }
}

}  // namespace pillarfield
