#include "pillarfield/wire_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/normal_equations.h"
#include "calibration/steps.h"
#include "calibration/wire_correction.h"
#include "pillarfield/error.h"
#include "skin/limits.h"

namespace pillarfield {
namespace {

/// Least reading under the body at rest above the median, as a fraction of the largest one.
constexpr double kLeastResting = 0.3;
constexpr std::size_t kLeastSensels = 8;
constexpr double kWireInsignificant = 3;
constexpr int kWireSteps = 10;
/// Step of the derivatives, and largest value, per count.
constexpr double kStep = 1e-7;
constexpr double kMostPerCount = 0.01;

/// Distance from the median reading, in median distances, up to which a sensel is bare.
constexpr double kNearMedian = 6;
/// Largest standard error of the conducting share that tells conductance from an offset.
constexpr double kClearShare = 0.1;

/// Row, column, idle.
using Resistances = std::array<double, 3>;

struct Share {
  double value = 0;
  double error = std::numeric_limits<double>::infinity();
};

/// The factor for which seen = factor · expected with the least sum of absolute differences: the
/// median of their ratios, weighted by the expected.
Share share_of(std::vector<std::pair<double, double>> changes) {
  if (changes.empty()) return {};
  std::ranges::sort(changes, {}, [](const auto& c) { return c.second / c.first; });
  double weights = 0;
  double squares = 0;
  for (const auto& [expected, seen] : changes) {
    weights += std::abs(expected);
    squares += expected * expected;
  }
  auto middle = changes.begin();
  double sum = std::abs(middle->first);
  while (sum < weights / 2) {
    ++middle;
    sum += std::abs(middle->first);
  }
  const double share = middle->second / middle->first;
  std::vector<double> left;
  left.reserve(changes.size());
  for (const auto& [expected, seen] : changes) left.push_back(std::abs(seen - share * expected));
  // 1.4826 median distances are a standard deviation; that of a median is sqrt(pi/2) of a mean's.
  return {share, 1.2533 * 1.4826 * median(left) / std::sqrt(squares)};
}

class WireFit {
 public:
  WireFit(std::span<const FrameStatistics> presses, const WireTile& tile,
          const std::vector<std::uint8_t>& mask)
      : tile_(tile), skin_(presses.front().skin()) {
    for (const FrameStatistics& press : presses) means_.push_back(mean_frame(press));
    std::vector<std::size_t> good;
    for (std::size_t i = 0; i < skin_.sensels(); ++i) {
      const auto is_good = [&](const FrameStatistics& press) {
        return press.sensels()[i].readings > 0 && press.sensels()[i].saturated == 0;
      };
      if ((mask.empty() || mask[i] == kGood) && std::ranges::all_of(presses, is_good)) {
        good.push_back(i);
      }
    }
    if (!good.empty()) find_bodies(good);
  }

  /// From now on tares are an offset, and no load of the wires.
  void set_offset() { tare_origin_ = TareOrigin::offset; }

  [[nodiscard]] std::size_t sensels() const { return resting_.size(); }

  /// Relative changes of the resting sensels' corrected readings against those of the body alone.
  [[nodiscard]] std::vector<double> changes(const Resistances& at) const {
    WireCorrection correct = correction(at);
    std::vector<double> alone;
    std::vector<double> changes;
    for (const FrameBuffer& mean : means_) {
      const FrameView corrected = correct.unlimited(mean.view());
      const auto* readings = static_cast<const float*>(corrected.data);
      for (std::size_t s = 0; s < resting_.size(); ++s) {
        const double reading = readings[resting_[s]];
        if (&mean == &means_.front()) {
          alone.push_back(reading);
        } else {
          const double change = (reading - alone[s]) / (alone[s] - unloaded_);
          changes.push_back(std::isfinite(change) ? change : 1);
        }
      }
    }
    return changes;
  }

  /// Equations of the resistances, linear around `at`.
  [[nodiscard]] NormalEquations linear_around(const Resistances& at) const {
    const std::vector<double> here = changes(at);
    std::array<std::vector<double>, 3> slopes;
    for (std::size_t p = 0; p < 3; ++p) {
      Resistances moved = at;
      moved.at(p) += kStep;
      slopes.at(p) = changes(moved);
      for (std::size_t i = 0; i < here.size(); ++i) {
        slopes.at(p)[i] = (slopes.at(p)[i] - here[i]) / kStep;
      }
    }
    NormalEquations equations(3);
    for (std::size_t i = 0; i < here.size(); ++i) {
      const Resistances row = {slopes[0][i], slopes[1][i], slopes[2][i]};
      equations.add(row, row[0] * at[0] + row[1] * at[1] + row[2] * at[2] - here[i]);
    }
    return equations;
  }

  /// Changes of unloaded sensels' readings under the other loads, as a part of those of sensels
  /// whose whole tare conducts. A median, since bodies touch some of them lightly.
  [[nodiscard]] Share conducting_share(const Resistances& at) const {
    WireCorrection correct = correction(at);
    std::vector<std::pair<double, double>> changes;  // expected, seen
    const auto before = corrected_gains(correct, means_[0]);
    for (std::size_t p = 1; p < means_.size(); ++p) {
      const auto after = corrected_gains(correct, means_[p]);
      for (std::size_t s = 0; s < bare_.size(); ++s) {
        const float reading = means_[0].readings<float>()[bare_[s]];
        const double expected = reading * (before[s] / after[s] - 1);
        const double seen = means_[p].readings<float>()[bare_[s]] - reading;
        if (!std::isfinite(expected) || expected == 0 || std::abs(seen) > near_) continue;
        changes.emplace_back(expected, seen);
      }
    }
    return share_of(std::move(changes));
  }

 private:
  /// Finds the sensels under the body at rest, and those that nothing touches beside it.
  void find_bodies(const std::vector<std::size_t>& good) {
    const std::span<const float> alone = std::as_const(means_[0]).readings<float>();
    std::vector<float> values;
    values.reserve(good.size());
    for (const std::size_t i : good) values.push_back(alone[i]);
    const float most = *std::ranges::max_element(values);
    const float unloaded = median(values);
    for (float& value : values) value = std::abs(value - unloaded);
    near_ = kNearMedian * median(values);
    unloaded_ = unloaded;
    tares_.assign(skin_.sensels(), unloaded);
    for (const std::size_t i : good) {
      const double rise = alone[i] - unloaded_;
      if (rise > kLeastResting * (most - unloaded_)) resting_.push_back(i);
      if (std::abs(rise) > near_) continue;
      tares_[i] = alone[i];
      bare_.push_back(i);
    }
  }

  [[nodiscard]] WireCorrection correction(const Resistances& at) const {
    return {"wires", skin_, SenselType::f32,
            WireCrosstalk{tile_.rows, tile_.cols, at[0], at[1], at[2], tare_origin_}, tares_};
  }

  /// Factors by which the correction raises the bare sensels.
  [[nodiscard]] std::vector<double> corrected_gains(WireCorrection& correct,
                                                    const FrameBuffer& mean) const {
    const FrameView corrected = correct.unlimited(mean.view());
    std::vector<double> gains;
    for (const std::size_t i : bare_) {
      gains.push_back(static_cast<const float*>(corrected.data)[i] / mean.readings<float>()[i]);
    }
    return gains;
  }

  WireTile tile_;
  Skin skin_;
  std::vector<FrameBuffer> means_;
  double unloaded_ = 0;
  double near_ = 0;                   ///< difference that a touch exceeds, counts
  std::vector<float> tares_;          ///< the median where a sensel is loaded
  std::vector<std::size_t> resting_;  ///< sensels under the body at rest
  std::vector<std::size_t> bare_;     ///< sensels that read no load in the first frames
  TareOrigin tare_origin_ = TareOrigin::conductance;
};

double rms_of(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

void require_wire_presses(const SkinCalibration& before, std::span<const FrameStatistics> presses,
                          const WireTile& tile) {
  if (presses.size() < 2) {
    throw Error("wires", "one file is too few",
                "give frames of a body alone, then with another one elsewhere");
  }
  for (const FrameStatistics& press : presses) {
    require_fitting(before, press.skin(), press.name());
    require_frames(press, 1);
  }
  SensorEffects effects;
  effects.wires = {tile.rows, tile.cols};
  check(effects, "wires");
}

Resistances fit_resistances(const WireFit& fit, Resistances at) {
  for (int step = 0; step < kWireSteps; ++step) {
    const std::vector<double> next = fit.linear_around(at).solve_non_negative({true, true, true});
    for (std::size_t p = 0; p < 3; ++p) at.at(p) = std::min(next[p], kMostPerCount);
  }
  return at;
}

}  // namespace

WireResult calibrate_wires(const SkinCalibration& before, std::span<const FrameStatistics> presses,
                           const WireTile& tile, std::optional<TareOrigin> tares) {
  require_wire_presses(before, presses, tile);
  WireFit fit(presses, tile, before.planes.mask);
  WireResult result;
  result.sensels = fit.sensels();
  if (result.sensels < kLeastSensels) {
    throw Error(presses[0].name(), "shows no body at rest",
                fmt::format("press {} sensels or more, less than half of the skin", kLeastSensels));
  }
  Resistances at{};
  result.residual_before = rms_of(fit.changes(at));
  at = fit_resistances(fit, at);
  const Share share = fit.conducting_share(at);
  result.conducting_share = share.value;
  if (share.error < kClearShare) {
    result.tares_shown = share.value > 0.5 ? TareOrigin::conductance : TareOrigin::offset;
  }
  const TareOrigin origin = tares.value_or(result.tares_shown.value_or(TareOrigin::conductance));
  if (origin == TareOrigin::offset) {
    fit.set_offset();
    at = fit_resistances(fit, at);
  }
  const NormalEquations equations = fit.linear_around(at);
  const std::vector<double> left = fit.changes(at);
  result.residual_after = rms_of(left);
  auto inverse = equations.inverse({true, true, true});
  // Without a resistance of the columns that of idle rows has no effect.
  if (!inverse) inverse = equations.inverse({true, true, false});
  if (!inverse) {
    throw Error("wires", "the other loads do not tell rows from columns",
                "press elsewhere in the rows of the resting body, then in its columns");
  }
  Resistances errors{};
  for (std::size_t p = 0; p < 3; ++p) {
    errors.at(p) = result.residual_after * std::sqrt((*inverse)[p * 3 + p]);
  }
  result.wires = {tile.rows, tile.cols, at[0], at[1], at[2], origin};
  result.standard_error = {tile.rows, tile.cols, errors[0], errors[1], errors[2]};
  result.found = at[0] > kWireInsignificant * errors[0] || at[1] > kWireInsignificant * errors[1];
  result.calibration = blank_calibration(presses[0].skin());
  result.calibration.planes.mask = before.planes.mask;
  if (result.found) result.calibration.planes.effects.wires = result.wires;
  return result;
}

namespace {

const char* name_of(TareOrigin tares) { return tares == TareOrigin::offset ? "offset" : "conduct"; }

/// Text on the tares: how they are taken, and what the frames tell of them.
std::string tares_text(const WireResult& result) {
  const std::string taken = result.wires.tares == TareOrigin::offset
                                ? "Tares are taken as an offset behind the wires"
                                : "Tares are taken as conductance";
  if (!result.tares_shown) return taken + "; the frames do not tell";
  return fmt::format("{}; {:.2f} of them conducts", taken, result.conducting_share);
}

void report_wires(StepReport& report, const WireResult& result) {
  const WireCrosstalk& wires = result.wires;
  const WireCrosstalk& error = result.standard_error;
  report.facts = {{"row_per_count", wires.row_per_count},
                  {"column_per_count", wires.column_per_count},
                  {"idle_per_count", wires.idle_per_count},
                  {"row_error", error.row_per_count},
                  {"column_error", error.column_per_count},
                  {"idle_error", error.idle_per_count},
                  {"sensels", result.sensels}};
  report.measure("residual_before", result.residual_before, "before",
                 "% change of their readings under other loads");
  report.measure("residual_after", result.residual_after, "after", "% left");
  report.facts["tares"] = name_of(wires.tares);
  report.facts["conducting_share"] = result.conducting_share;
  report.facts["stored"] = result.found;
  const auto line = [](const char* name, double value, double deviation) {
    return fmt::format("  {:<7} {:.3f} ± {:.3f}", name, 1e6 * value, 1e6 * deviation);
  };
  report.notes = {"Resistance times conductance of a count, in millionths:",
                  line("row", wires.row_per_count, error.row_per_count),
                  line("column", wires.column_per_count, error.column_per_count),
                  line("idle", wires.idle_per_count, error.idle_per_count), tares_text(result)};
  if (!result.found) report.notes.emplace_back("Within three standard errors of 0: none is stored");
  if (!result.found || result.tares_shown.value_or(wires.tares) == wires.tares) return;
  report.warnings.push_back(
      fmt::format("--tares {}: the frames show {}; leave the option out, or check it",
                  name_of(wires.tares), name_of(*result.tares_shown)));
}

SkinCalibration run_wires(StepWork& work) {
  WireTile tile;
  tile.rows = static_cast<std::uint32_t>(work.number("tile-rows", tile.rows));
  tile.cols = static_cast<std::uint32_t>(work.number("tile-cols", tile.cols));
  std::optional<TareOrigin> tares;
  if (const auto word = work.word("tares")) {
    tares = *word == "offset" ? TareOrigin::offset : TareOrigin::conductance;
  }
  const WireResult result =
      calibrate_wires(work.before, work.statistics(WireUse::none), tile, tares);
  work.report.headline = fmt::format("Compared {} in {}", counted(result.sensels, "sensel"),
                                     counted(work.files.size(), "file"));
  report_wires(work.report, result);
  work.parameters =
      fmt::format("tile = {} x {}, tares = {}", tile.rows, tile.cols, name_of(result.wires.tares));
  return result.calibration;
}

}  // namespace

StepKind wires_step() {
  StepKind step = {
      "wires", "Row and column crosstalk, from a body at rest while another one presses elsewhere.",
      "RESTING",
      "Frames of a body alone, then files with another one in its rows and in its columns",
      run_wires};
  step.before = StepKind::Before::none;
  step.arguments = {
      StepArgument::whole("tile-rows", "Sensel rows that share wires [64]", kTileSensels),
      StepArgument::whole("tile-cols", "Sensel columns that share wires [64]", kTileSensels),
      StepArgument::word("tares", {"conduct", "offset"},
                         "How tares arise. conduct: unloaded sensels conduct; offset: the "
                         "converter adds it [as the frames show, or else conduct]")};
  step.examples = {"simulate scenes/calibration/wired_skin_alone.toml --uncalibrated -o alone.h5",
                   "simulate scenes/calibration/wired_skin_row.toml --uncalibrated -o row.h5",
                   "simulate scenes/calibration/wired_skin_column.toml --uncalibrated -o column.h5",
                   "calibrate wires alone.h5 row.h5 column.h5 --tile-rows 40 --tile-cols 40 -o "
                   "wires.h5"};
  return step;
}

}  // namespace pillarfield
