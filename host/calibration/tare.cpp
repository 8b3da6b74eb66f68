#include "pillarfield/tare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/finding_list.h"
#include "calibration/neighbours.h"
#include "calibration/sensel_judge.h"
#include "calibration/steps.h"
#include "calibration/touch_search.h"
#include "pillarfield/error.h"
#include "pillarfield/untouched_skin.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

/// Distance from the typical level, in spreads, of neighbours that stand out together.
constexpr double kStandsOut = 3;
/// Distance, in spreads, that at most the share kMostFarOut of sound sensels exceeds alone.
constexpr double kFarOut = 6;
constexpr double kMostFarOut = 0.05;

/// Distance from the common change, in robust standard deviations of the changes.
constexpr double kFarChange = 6;
/// Least change that is noticed: in noises of a reading, and of whole counts.
constexpr double kLeastChangeNoises = 8;
constexpr double kLeastChangeCounts = 3;
/// Most by which unlike drift of the sensels may raise that.
constexpr double kUnlikeDrift = 4;
/// Factor on the limit where the levels of the sensels stand for a tare before.
constexpr double kUneven = 2;
/// Factor on the threshold from which a tare is much worse than the one before.
constexpr double kMuchNoise = 2;

std::string place_words(const FrameStatistics& frames, std::size_t sensel) {
  const std::uint32_t cols = frames.skin().cols;
  return fmt::format("row {}, column {}", sensel / cols, sensel % cols);
}

[[noreturn]] void refuse(const FrameStatistics& unloaded, const std::string& failure,
                         const char* otherwise) {
  std::string mend = "let nothing touch the skin and take the tare again";
  if (otherwise != nullptr) mend += fmt::format(", or {}", otherwise);
  throw Error(unloaded.name(), failure, mend);
}

void refuse(const TareFrames& unloaded, const MovingTouch& touch, const char* otherwise) {
  refuse(unloaded,
         fmt::format("something touched {} {}: {} by {:.3g} counts",
                     touch.covers_all ? "the array" : place_words(unloaded, touch.sensel),
                     unloaded.span_words(touch.first, touch.last),
                     touch.covers_all ? "all sensels changed" : "neighbours changed together",
                     touch.counts),
         otherwise);
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

/// The first sensel whose value lies above those of others together with those beside it, if any: a
/// cross or a square of four sensels, of which there are far more than by chance.
std::optional<std::size_t> standing_out(const Skin& skin, const std::vector<double>& values,
                                        const std::vector<std::uint8_t>& used,
                                        double least_spread) {
  if (skin.layout == SkinLayout::pillars) {  // Under shear the sensels of a pillar differ.
    Skin pillars = skin;
    pillars.rows = skin.pillar_rows();
    pillars.cols = skin.pillar_cols();
    pillars.layout = SkinLayout::sensels;
    std::vector<double> means;
    std::vector<std::uint8_t> usable;
    const auto corner = [&](std::size_t p) {
      return 2 * (p / pillars.cols * skin.cols + p % pillars.cols);
    };
    for (std::size_t p = 0; p < pillars.sensels(); ++p) {
      const std::size_t i = corner(p);
      const std::array<std::size_t, 4> four = {i, i + 1, i + skin.cols, i + skin.cols + 1};
      double sum = 0;
      for (const std::size_t each : four) sum += values[each];
      means.push_back(sum / 4);
      usable.push_back(std::ranges::all_of(four, [&](auto each) { return used[each] != 0; }));
    }
    const auto at = standing_out(pillars, means, usable, least_spread / 2);
    return at ? std::optional(corner(*at)) : at;
  }
  std::vector<double> sorted;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (used[i] != 0) sorted.push_back(values[i]);
  }
  if (sorted.empty()) return std::nullopt;
  const double middle = median(sorted);
  for (double& each : sorted) each = std::abs(each - middle);
  // The median deviation of a normal distribution is 0.6745 of its standard deviation.
  const double spread = std::max(1.4826 * median(sorted), least_spread);
  for (double limit = kStandsOut * spread; limit < 1e3 * kStandsOut * spread; limit *= 1.5) {
    const auto stands_out = [&](std::size_t i) {
      return used[i] != 0 && values[i] > middle + limit;
    };
    std::optional<std::size_t> first;
    double together = 0;
    double share = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!stands_out(i)) continue;
      share += 1 / static_cast<double>(sorted.size());
      const Neighbours around(skin, i);
      const auto edges = around.edges();
      const auto tested = std::ranges::count_if(edges, [&](std::size_t n) { return used[n] != 0; });
      const auto out = std::ranges::count_if(edges, stands_out);
      const std::size_t below = i + skin.cols;
      const bool is_square = (i + 1) % skin.cols != 0 && below < values.size() &&
                             stands_out(i + 1) && stands_out(below) && stands_out(below + 1);
      const bool is_cross = tested >= 2 && out >= std::min<std::ptrdiff_t>(3, tested);
      if (!is_cross && !is_square) continue;
      ++together;
      if (!first) first = i;
    }
    // A touch of a small array is itself a large share of what stands far out.
    const double chance = limit > kFarOut * spread ? std::min(share, kMostFarOut) : share;
    const double by_chance = 6 * static_cast<double>(sorted.size()) * std::pow(chance, 4);
    if (together > (by_chance < 0.01 ? 0 : 10 + 5 * by_chance)) return first;
    if (share == 0) break;
  }
  return std::nullopt;
}

/// Throws if neighbours stand out together.
void refuse_resting_touch(const FrameStatistics& unloaded, const std::vector<std::uint8_t>& mask,
                          const SenselJudge& judge, const char* otherwise) {
  std::vector<double> levels;
  std::vector<std::uint8_t> used;
  for (std::size_t i = 0; i < unloaded.sensels().size(); ++i) {
    levels.push_back(judge.sensels()[i].level);
    const auto fault = judge.verdict(i).value_or(SenselFault::saturated);  // or none
    // A constant low reading is that of a dead sensel.
    const bool may_be_touched =
        fault == SenselFault::saturated || (fault == SenselFault::stuck && judge.is_far_above(i));
    used.push_back((mask.empty() || mask[i] == kGood) && may_be_touched ? 1 : 0);
  }
  for (const char* const side_words : {"above", "below"}) {
    const auto at = standing_out(unloaded.skin(), levels, used, judge.typical().noise);
    if (at) {
      refuse(unloaded,
             fmt::format("{} and its neighbours read in all frames as if something touched them, "
                         "{:.3g} counts {} the others",
                         place_words(unloaded, *at),
                         std::abs(judge.sensels()[*at].level - judge.typical().level), side_words),
             otherwise);
    }
    for (double& level : levels) level = -level;
  }
}

/// Rise of the readings since a tare before, without the change that all sensels have in common.
struct TareChange {
  TareChange(const FrameStatistics& unloaded, const std::vector<float>& before,
             const Calibration& now);

  double limit = 0;  ///< counts that noise and drift explain
  double most = 0;   ///< counts
  std::size_t place = 0;
  std::uint64_t beyond = 0;  ///< sensels beyond the limit, or together with neighbours
};

TareChange::TareChange(const FrameStatistics& unloaded, const std::vector<float>& before,
                       const Calibration& now) {
  std::vector<double> changes;
  std::vector<double> noises;
  std::vector<double> all(now.noise.size());
  std::vector<std::uint8_t> used(all.size());
  const auto change_of = [&](std::size_t i) {
    return unloaded.sensels()[i].mean - (before.empty() ? 0 : before[i]);
  };
  for (std::size_t i = 0; i < now.noise.size(); ++i) {
    if (!is_good(now, i)) continue;
    changes.push_back(all[i] = change_of(i));
    used[i] = 1;
    noises.push_back(now.noise[i]);
  }
  const double common = median(changes);
  for (double& change : changes) change = std::abs(change - common);
  const double rounding = unloaded.type() == SenselType::f32 ? 0 : kLeastChangeCounts;
  const double least = std::max(kLeastChangeNoises * quantile(noises, 0.99), rounding);
  // The median deviation of a normal distribution is 0.6745 of its standard deviation.
  limit = std::max(kFarChange * 1.4826 * median(changes), least);
  limit = before.empty() ? kUneven * limit : std::min(limit, kUnlikeDrift * least);
  for (std::size_t i = 0; i < now.noise.size(); ++i) {
    const double change = is_good(now, i) ? change_of(i) - common : 0;
    beyond += change > limit ? 1 : 0;
    if (change > most) place = i;
    most = std::max(most, change);
  }
  if (before.empty() || beyond > 0) return;
  const auto together =
      standing_out(unloaded.skin(), all, used, std::max(median(noises), rounding / 3));
  if (together) beyond = 1;
}

bool has_tare(const Calibration& planes) {
  return std::ranges::any_of(planes.tare, [](float tare) { return tare != 0; });
}

/// Throws if sensels rose since the tare before, were good in it, or if that had far less noise.
void refuse_worse_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                       const TareResult& result, const TareChange& change, const char* otherwise) {
  if (change.beyond > 0) {
    refuse(
        unloaded,
        fmt::format(
            "{} changed since the tare before by more than noise and drift explain, "
            "most by {:.3g} counts at {}, in all frames; a touch of less than {:.3g} counts on a "
            "sensel would not be seen",
            counted(change.beyond, "sensel"), change.most, place_words(unloaded, change.place),
            change.limit),
        otherwise);
  }
  // A sensel that was masked has no noise.
  const auto was_good = [&](const SenselFinding& finding) {
    const auto& noise = before.planes.noise;
    return !noise.empty() && noise[std::size_t{finding.row} * before.cols + finding.col] > 0;
  };
  if (const auto masked = std::ranges::count_if(result.findings, was_good); masked > 0) {
    const SenselFinding& first = *std::ranges::find_if(result.findings, was_good);
    refuse(unloaded,
           fmt::format("{} that read well in the tare before read as faulty, the first, at row {}, "
                       "column {}, as {}",
                       counted(static_cast<std::uint64_t>(masked), "sensel"), first.row, first.col,
                       name_of(first.fault)),
           otherwise);
  }
  const double threshold = *result.calibration.threshold_counts;
  if (before.planes.noise.empty() || !before.threshold_counts || !before.threshold_factor) return;
  const double known =
      *before.threshold_counts / *before.threshold_factor * *result.calibration.threshold_factor;
  if (threshold <= kMuchNoise * known) return;
  refuse(unloaded,
         fmt::format("the threshold would be {:.3g} counts, that of the tare before is {:.3g}: "
                     "readings are not at rest",
                     threshold, known),
         otherwise);
}

/// Fills tare and noise; zero for masked sensels.
void fill_planes(const FrameStatistics& still, const FindingList& found, Calibration& planes) {
  const std::vector<SenselEvidence> evidence = evidence_without_load(still);
  const std::size_t sensels = evidence.size();
  planes.tare.assign(sensels, 0);
  planes.noise.assign(sensels, 0);
  for (std::size_t i = 0; i < sensels; ++i) {
    if (!found.good(i)) continue;
    planes.tare[i] = static_cast<float>(evidence[i].level);
    planes.noise[i] = static_cast<float>(evidence[i].noise);
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

void TareFrames::add(const FrameView& frame, double time_s) {
  constexpr std::size_t kMostFrames = 4096;
  constexpr std::size_t kMostReadings = std::size_t{1} << 24U;
  constexpr std::size_t kLeastKept = 32;
  const std::size_t most = std::clamp(kMostReadings / skin().sensels(), kLeastKept, kMostFrames);
  FrameStatistics::add(frame);
  if ((frames() - 1) % step_ != 0) return;
  if (kept_.size() == most) {
    step_ *= 2;
    for (std::size_t i = 0; 2 * i < most; ++i) {
      std::swap(kept_[i], kept_[2 * i]);
      times_s_[i] = times_s_[2 * i];
    }
    kept_.resize((most + 1) / 2);
    times_s_.resize(kept_.size());
    if ((frames() - 1) % step_ != 0) return;
  }
  std::vector<float>& to = kept_.emplace_back();
  to.reserve(skin().sensels());
  for_each_row(frame, [&](std::size_t, const auto* readings) {
    to.insert(to.end(), readings, readings + frame.cols);
  });
  times_s_.push_back(time_s);
}

std::string TareFrames::span_words(std::size_t first, std::size_t last) const {
  if (std::isfinite(times_s_[first])) {
    return fmt::format("from {:.3g} to {:.3g} s", times_s_[first], times_s_[last]);
  }
  if (first == last) return fmt::format("in frame {}", first * step_);
  return fmt::format("in frames {} to {}", first * step_, last * step_);
}

void refuse_moving_touch(const TareFrames& unloaded, std::span<const std::uint8_t> mask,
                         const char* otherwise) {
  if (const auto touch = examine_frames(unloaded, mask).touch) refuse(unloaded, *touch, otherwise);
}

TareResult take_tare(const SkinCalibration& before, const TareFrames& unloaded,
                     const TareOptions& options) {
  require_fitting(before, unloaded.skin(), unloaded.name());
  require_frames(unloaded, kLeastTareFrames);
  const ExaminedFrames examined = examine_frames(unloaded, before.planes.mask);
  const FrameStatistics& still = examined.still;
  FindingList found(before.planes.mask, still);
  std::vector<SenselEvidence> evidence = evidence_without_load(still);
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    evidence[i].noise = std::max(examined.noises[i], least_noise(still.type()));
  }
  const SenselJudge judge(std::move(evidence), still.frames(), before.planes.mask);
  if (judge.typical().count == 0) {
    throw Error(unloaded.name(), "no sensel has a valid tare",
                "check the sensor, its full scale and its mask");
  }
  // A tare before knows better than the other sensels how a sensel reads untouched.
  const std::vector<float> known =
      has_tare(before.planes) ? before.planes.tare : std::vector<float>();
  if (!options.preloaded) {
    if (examined.touch) refuse(unloaded, *examined.touch, options.otherwise);
    if (known.empty()) {
      refuse_resting_touch(still, before.planes.mask, judge, options.otherwise);
    }
  }
  for (std::size_t i = 0; i < still.sensels().size(); ++i) {
    if (!found.good(i)) continue;
    if (const auto fault = judge.verdict(i)) found.mask(i, *fault);
  }
  require_majority(found, still);
  TareResult result;
  result.calibration = before;
  fill_planes(still, found, result.calibration.planes);
  set_threshold(result.calibration, options.threshold_factor);
  result.findings = found.findings();
  result.tare_counts = judge.typical().level;
  std::vector<float> noises;
  for (std::size_t i = 0; i < still.sensels().size(); ++i) {
    if (found.good(i)) noises.push_back(result.calibration.planes.noise[i]);
  }
  result.noise_counts = median(noises);
  result.spikes = examined.spikes;
  const TareChange change(still, known, result.calibration.planes);
  result.unseen_counts = change.limit;
  if (!options.preloaded && !known.empty()) {
    refuse_worse_tare(before, still, result, change, options.otherwise);
  }
  return result;
}

namespace {

SkinCalibration run_tare(StepWork& work) {
  const TareOptions options = {.threshold_factor = work.number("threshold-factor", 4),
                               .preloaded = work.number("preloaded", 0) != 0};
  const TareFrames unloaded = std::move(work.unloaded_frames().front());
  refuse_equal_frames(unloaded);
  const TareResult result = take_tare(work.before, unloaded, options);
  const SkinCalibration& calibration = result.calibration;
  StepReport& report = work.report;
  report.headline = fmt::format("Tare of {} x {} sensels from {}", calibration.rows,
                                calibration.cols, counted(work.frames(), "frame"));
  report.measure("tare_counts", result.tare_counts, "tare", "counts, median of the valid sensels");
  report.measure("noise_counts", result.noise_counts, "noise",
                 "counts, median of the valid sensels");
  report.measure("unseen_counts", result.unseen_counts, "unseen",
                 "counts, a touch at rest on each of a few sensels that would not have been seen");
  report.measure("untouched_share", untouched_share(calibration), "untouched",
                 "% of the untouched skin would have a status");
  report.measure(
      "threshold_counts", *calibration.threshold_counts, "threshold",
      fmt::format("counts, {:g} times the 99th percentile of the noise", options.threshold_factor));
  report.add(calibration, result.findings);
  if (result.spikes > 0) {
    report.notes.push_back(fmt::format("Left out: {}, which stand out for one frame or two",
                                       counted(result.spikes, "reading")));
  }
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
      StepArgument::flag(
          "preloaded",
          "Accept what resembles a touch, as of a bent or covered skin, and a tare much "
          "worse than the one before")};
  step.examples = {kSimulateIdle, kTareIdle,
                   "calibrate tare idle.h5 -o strict.h5 --threshold-factor 6"};
  return step;
}

}  // namespace pillarfield
