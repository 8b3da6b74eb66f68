#include "pillarfield/doctor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/kept_frames.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kPeriodIntervals = 1024;  ///< first ones, whose median is the period
constexpr double kGapPeriods = 1.5;
constexpr std::size_t kListedGaps = 20;

/// Rate, jitter and gaps of frames at these times, s; NaN: a frame without one.
FrameTiming timing_of(const std::vector<double>& times) {
  std::vector<double> first;
  for (std::size_t i = 1; i < times.size() && first.size() < kPeriodIntervals; ++i) {
    if (std::isfinite(times[i] - times[i - 1])) first.push_back(times[i] - times[i - 1]);
  }
  const double period_s = first.empty() ? 0 : median(first);
  FrameTiming timing;
  if (!(period_s > 0)) return timing;
  timing.rate_hz = 1 / period_s;
  double intervals = 0;
  double mean = 0;
  double squares = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double length = times[i] - times[i - 1];
    if (!std::isfinite(length)) continue;
    if (length > kGapPeriods * period_s) {
      ++timing.gap_count;
      timing.lost += static_cast<std::uint64_t>(
          std::max(1.0, std::min(1e15, std::round(length / period_s) - 1)));
      if (timing.gaps.size() < kListedGaps) timing.gaps.push_back({i, times[i], length});
      continue;
    }
    const double step = length - mean;
    mean += step / ++intervals;
    squares += step * (length - mean);
  }
  if (intervals > 1) timing.jitter_ms = 1e3 * std::sqrt(squares / (intervals - 1));
  return timing;
}

constexpr std::uint32_t kLeastDoctorFrames = 10;

/// The skin with the largest reading that its type can hold as its full scale, unless it states
/// one.
Skin with_full_scale(Skin skin, SenselType type) {
  if (!skin.full_scale_counts && type == SenselType::u8) skin.full_scale_counts = 255;
  if (!skin.full_scale_counts && type == SenselType::u16) skin.full_scale_counts = 65535;
  return skin;
}

/// Statistics of the kept frames.
std::vector<SenselStatistics> statistics_of(const KeptFrames& kept, double full_scale) {
  std::vector<SenselStatistics> statistics(kept.sensels());
  for (std::size_t frame = 0; frame < kept.frames(); ++frame) {
    const auto readings = kept.frame(frame);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      statistics[i].add(readings[i], static_cast<float>(full_scale));
    }
  }
  return statistics;
}

void require_readings(const FrameStatistics& statistics) {
  const auto is_empty = [](const SenselStatistics& sensel) { return sensel.readings == 0; };
  if (!std::ranges::all_of(statistics.sensels(), is_empty)) return;
  throw Error(statistics.name(), "has no readings: all of its values are NaN or beyond 1e33",
              "give frames of numbers");
}

}  // namespace

bool Diagnosis::is_no_force() const {
  return std::ranges::any_of(findings, [](const ArrayFinding& finding) {
    return finding.fault == ArrayFault::normalised || finding.fault == ArrayFault::two_values ||
           finding.fault == ArrayFault::byte_order || finding.fault == ArrayFault::frozen;
  });
}

struct Doctor::State {
  State(std::string name, const Skin& skin, SenselType type)
      : statistics(std::move(name), with_full_scale(skin, type), type),
        kept(skin.rows, skin.cols) {}

  FrameStatistics statistics;
  std::vector<double> times;  ///< of all frames, s
  KeptFrames kept;
  FrameWatch watch;
};

Doctor::Doctor(std::string name, const Skin& skin, SenselType type)
    : state_(std::make_unique<State>(std::move(name), skin, type)) {}
Doctor::~Doctor() = default;
Doctor::Doctor(Doctor&&) noexcept = default;
Doctor& Doctor::operator=(Doctor&&) noexcept = default;

void Doctor::add(const FrameView& frame, double time_s) {
  state_->statistics.add(frame);
  state_->times.push_back(time_s);
  state_->kept.add(frame, time_s, state_->watch.add(frame));
}

Diagnosis Doctor::result() {
  const FrameStatistics& statistics = state_->statistics;
  require_frames(statistics, kLeastDoctorFrames);
  require_readings(statistics);
  const Skin& skin = statistics.skin();
  Diagnosis found;
  found.rows = skin.rows;
  found.cols = skin.cols;
  found.type = statistics.type();
  found.layout = skin.layout;
  found.frames = statistics.frames();
  found.kept = state_->kept.frames();
  found.timing = timing_of(state_->times);
  const FrameWatch& watch = state_->watch;
  Examination seen = {.statistics = statistics, .kept = state_->kept};
  if (!watch.is_frozen()) {
    if (watch.uniform_are_lost()) seen.kept.drop(FrameKind::uniform);
    if (watch.repeats_are_odd()) seen.kept.drop(FrameKind::repeated);
    seen.kept.drop(FrameKind::empty);
  }
  seen.rows = skin.rows;
  seen.cols = skin.cols;
  seen.full_scale = skin.full_scale_counts.value_or(std::numeric_limits<double>::infinity());
  const bool has_dropped =
      seen.kept.frames() * seen.kept.stride() + seen.kept.stride() < found.frames;
  seen.read.assign(statistics.sensels().begin(), statistics.sensels().end());
  if (has_dropped) seen.read = statistics_of(seen.kept, seen.full_scale);
  for (auto* const plane : {&seen.idle, &seen.noise, &seen.jitter, &seen.lowest, &seen.highest}) {
    plane->resize(skin.sensels());
  }
  seen.touched.resize(skin.sensels());
  seen.noisy.resize(skin.sensels());
  seen.good.assign(skin.sensels(), 1);
  for (const SenselStatistics& each : seen.read) {
    seen.constant.push_back(each.readings == 0 || each.lowest == each.highest ? 1 : 0);
  }
  find_odd_frames(seen, watch, found);
  find_signals(seen, found);
  find_odd_sensels(seen, found);
  if (!found.is_no_force()) {
    find_shorts(seen, found);
    find_line_orders(seen, found);
    find_ghosts(seen, found);
    find_rests(seen, found);
  }
  find_responses(seen, found);
  found.verdicts = seen.verdicts;
  for (std::size_t i = 0; i < skin.sensels(); ++i) {
    found.clipped += seen.good[i] != 0 && seen.read[i].saturated > 0 ? 1U : 0U;
  }
  std::ranges::stable_sort(found.findings, {}, &ArrayFinding::fault);
  return found;
}

}  // namespace pillarfield
