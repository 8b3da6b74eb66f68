#include "pillarfield/reading_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pillarfield/calibration.h"
#include "pillarfield/status.h"
#include "pipeline/line_check.h"
#include "pipeline/parity_check.h"

namespace pillarfield {
namespace {

constexpr double kNearlyAll = 0.95;
constexpr double kHardlyAny = 0.01;

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

ReadingCheck::ReadingCheck(const SolverPlan& plan, bool judges_errors)
    : plan_(plan),
      present_(plan.skin.elements() - count_absent_elements(plan.calibration, plan.skin)),
      lines_(std::make_shared<LineCheck>(plan)) {
  if (judges_errors) parity_ = std::make_shared<ParityCheck>(plan);
}

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
  if (parity_ && frame.readings.data != nullptr) parity_->add(frame.readings);
  if (frame.readings.data != nullptr && touched > 0) lines_->add(frame.readings);
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
  if (parity_) std::ranges::move(parity_->found().sentences(false), std::back_inserter(sentences));
  std::ranges::move(lines_->warnings(), std::back_inserter(sentences));
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
