#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"

namespace pillarfield {
namespace {

/// The signals of a frame with a contact, by the places of the sensels, and what a place must show
/// of the contact if its neighbours are right.
class LyingSignals {
 public:
  LyingSignals(const Examination& seen, std::uint32_t frame);

  [[nodiscard]] float of(std::size_t sensel) const { return signals_[sensel]; }

  /// Signal that three quarters of the good neighbours exceed; 0 with fewer than three of them.
  [[nodiscard]] float least_under_contact(std::uint32_t row, std::uint32_t col) const;

  /// The same for one small contact, without holes: what lies between two loaded neighbours is
  /// loaded, and what lies beside its peak.
  [[nodiscard]] float least_under_small_contact(std::uint32_t row, std::uint32_t col) const;

 private:
  /// The signal of a good sensel at a place; null if there is none.
  [[nodiscard]] const float* at(std::uint32_t row, std::uint32_t col) const;
  /// Half of what a Gaussian of the peak's other neighbours has there: flank² / opposite, at most
  /// flank.
  [[nodiscard]] float least_beside_peak(std::uint32_t row, std::uint32_t col) const;

  const Examination& seen_;
  std::span<const float> signals_;
  SenselPlace peak_;
};

/// Steps down and to the right, modulo 2^32.
struct SenselStep {
  std::uint32_t down;
  std::uint32_t right;
};
constexpr std::uint32_t kBack = ~0U;
/// One of each opposite pair of neighbours; the first two share an edge with the sensel.
constexpr std::array<SenselStep, 4> kPairs = {{{0, 1}, {1, 0}, {1, 1}, {1, kBack}}};
constexpr std::array<SenselStep, 4> kSides = {{{0, 1}, {1, 0}, {0, kBack}, {kBack, 0}}};
/// Part of a round contact's signal that is expected, and share of its peak from which it is flat.
constexpr float kBesidePeak = 0.5F;
constexpr float kFlat = 0.85F;

LyingSignals::LyingSignals(const Examination& seen, std::uint32_t frame)
    : seen_(seen), signals_(std::as_const(seen.kept).frame(frame)) {
  float most = 0;
  for (std::uint32_t row = 0; row < seen.rows; ++row) {
    for (std::uint32_t col = 0; col < seen.cols; ++col) {
      const float* const signal = at(row, col);
      if (signal == nullptr || *signal <= most) continue;
      most = *signal;
      peak_ = {row, col};
    }
  }
}

const float* LyingSignals::at(std::uint32_t row, std::uint32_t col) const {
  if (row >= seen_.rows || col >= seen_.cols) return nullptr;
  const std::size_t i = seen_.sensel(LineAxis::rows, row, col);
  return seen_.good[i] != 0 ? &signals_[i] : nullptr;
}

float LyingSignals::least_under_contact(std::uint32_t row, std::uint32_t col) const {
  std::array<float, 8> around{};
  std::size_t count = 0;
  for (const auto& [down, right] : kPairs) {
    for (const float* const signal : {at(row + down, col + right), at(row - down, col - right)}) {
      if (signal != nullptr) around.at(count++) = *signal;
    }
  }
  if (count < 3) return 0;
  const std::size_t rank = (3 * count + 3) / 4 - 1;
  std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(rank),
                   around.begin() + static_cast<std::ptrdiff_t>(count), std::greater<>());
  return around.at(rank);
}

float LyingSignals::least_under_small_contact(std::uint32_t row, std::uint32_t col) const {
  float least = least_beside_peak(row, col);
  for (const auto& [down, right] : kPairs) {
    const float* const one = at(row + down, col + right);
    const float* const other = at(row - down, col - right);
    if (one != nullptr && other != nullptr) least = std::max(least, std::min(*one, *other));
  }
  return least;
}

float LyingSignals::least_beside_peak(std::uint32_t row, std::uint32_t col) const {
  const std::uint32_t down = row - peak_.first;
  const std::uint32_t right = col - peak_.second;
  const bool is_beside = std::ranges::any_of(
      kSides, [&](const SenselStep& step) { return step.down == down && step.right == right; });
  if (!is_beside) return 0;
  const float peak = *at(peak_.first, peak_.second);
  const float* const opposite = at(peak_.first - down, peak_.second - right);
  float flank = std::numeric_limits<float>::infinity();
  for (const float* const signal : {at(peak_.first + right, peak_.second + down),
                                    at(peak_.first - right, peak_.second - down)}) {
    if (signal != nullptr) flank = std::min(flank, *signal);
  }
  const bool is_peaked = opposite != nullptr && *opposite < kFlat * peak && flank < kFlat * peak;
  if (!is_peaked || flank <= 0) return 0;
  return *opposite <= flank ? kBesidePeak * flank : kBesidePeak * flank * flank / *opposite;
}

/// Response relative to that of the neighbours below which a sensel is dead, and what is added to
/// it for each part of crosstalk.
constexpr double kDeadResponse = 0.12;
constexpr double kDeadCrosstalk = 3;
constexpr double kMostDeadResponse = 0.42;
/// The same where no small contact was swept over the array, of sensels that are never loaded:
/// large contacts have edges and holes.
constexpr double kSilentResponse = 0.04;
/// Load of neighbours that tests a sensel, relative to the usual largest signal and to the noise.
constexpr double kTestShare = 0.1;
constexpr double kSweepShare = 0.08;
constexpr double kTestNoise = 4;
/// Share of a line's sensels that must be faulty, while none responds, for a dead line.
constexpr double kDeadLineShare = 0.15;
/// Mean number of sensels that a finger loads on a coarse array, and least share of its sensels
/// that it must have loaded for the others to be dead.
constexpr double kFewSensels = 4;
constexpr double kAllSensels = 0.8;
/// Signal of a weak touch in the usual one, and the largest noise of a silent sensel in deviations.
constexpr double kWeakTouch = 0.2;
constexpr double kSilentNoise = 4.5;

/// The kind of finding of a verdict.
ArrayFault finding_of(SenselFault fault) {
  switch (fault) {
    case SenselFault::not_a_number:
    case SenselFault::absent:
      return ArrayFault::absent;
    case SenselFault::stuck:
      return ArrayFault::stuck;
    case SenselFault::saturated:
      return ArrayFault::saturated;
    case SenselFault::noisy:
      return ArrayFault::noisy;
    default:
      return ArrayFault::dead;
  }
}

/// The verdicts on sensels by those around them, after those by their readings.
class NeighbourVerdicts {
 public:
  explicit NeighbourVerdicts(Examination& seen)
      : seen_(seen), responses_(seen.kept.sensels()), in_dead_line_(seen.kept.sensels()) {}

  void judge(double crosstalk) {
    dead_response_ = seen_.was_swept
                         ? std::min(kMostDeadResponse, kDeadResponse + kDeadCrosstalk * crosstalk)
                         : kSilentResponse;
    // The second time, dead neighbours do not count.
    for (int pass = 0; pass < 2; ++pass) judge_responses();
    judge_untouched();
  }

  void report(Diagnosis& found) {
    report_lines(LineAxis::rows, ArrayFault::dead_row, found);
    report_lines(LineAxis::columns, ArrayFault::dead_column, found);
    for (const ArrayFault fault : {ArrayFault::absent, ArrayFault::dead, ArrayFault::stuck,
                                   ArrayFault::saturated, ArrayFault::noisy}) {
      report_sensels(fault, found);
    }
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (!seen_.verdicts[i] && seen_.touched[i] == 0 && !is_tested(i)) {
        found.untouched.push_back(seen_.place(i));
      }
    }
    found.verdicts = seen_.verdicts;
  }

 private:
  [[nodiscard]] const SenselStatistics& read(std::size_t sensel) const {
    return seen_.read[sensel];
  }
  void accuse(std::size_t sensel) {
    if (!seen_.verdicts[sensel]) seen_.verdicts[sensel] = SenselFault::unresponsive;
    seen_.good[sensel] = 0;
  }

  /// True if a sensel shows nothing but noise, and would show a weak touch.
  [[nodiscard]] bool is_silent(std::size_t sensel) const {
    if (seen_.touched[sensel] > 0 || kWeakTouch * seen_.contact_counts < seen_.threshold(sensel)) {
      return false;
    }
    for (std::size_t frame = 0; frame < seen_.kept.frames(); ++frame) {
      if (std::as_const(seen_.kept).frame(frame)[sensel] > kSilentNoise * seen_.noise_of(sensel)) {
        return false;
      }
    }
    return true;
  }

  /// A finger that pressed nearly all sensels of a coarse array, each by itself, pressed the others
  /// too.
  void judge_untouched() {
    double loaded = 0;
    for (const std::uint32_t count : seen_.touched) loaded += count;
    if (loaded > kFewSensels * static_cast<double>(seen_.contacts.size())) return;
    const auto is_touched = [&](LineAxis axis, std::size_t line) {
      const std::size_t length = responses_.size() / seen_.lines(axis);
      for (std::size_t along = 0; line < seen_.lines(axis) && along < length; ++along) {
        if (seen_.touched[seen_.sensel(axis, line, along)] > 0) return true;
      }
      return line >= seen_.lines(axis);
    };
    const auto may_be_dead = [&](LineAxis axis, std::size_t line) {
      return is_touched(axis, line) || (is_touched(axis, line - 1) && is_touched(axis, line + 1));
    };
    double tested = 0;
    double touched = 0;
    std::vector<std::size_t> silent;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      const std::size_t row = i / seen_.cols;
      const std::size_t col = i % seen_.cols;
      if (seen_.good[i] == 0) continue;
      if (is_silent(i) && may_be_dead(LineAxis::rows, row) && may_be_dead(LineAxis::columns, col)) {
        silent.push_back(i);
      }
      if (!is_touched(LineAxis::rows, row) || !is_touched(LineAxis::columns, col)) continue;
      ++tested;
      touched += seen_.touched[i] > 0 ? 1 : 0;
    }
    if (touched < kAllSensels * tested) return;
    for (const std::size_t i : silent) accuse(i);
  }

  void judge_responses() {
    const double least = (seen_.was_swept ? kSweepShare : kTestShare) * seen_.contact_counts;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (seen_.good[i] != 0) responses_[i] = SenselResponse();
    }
    for (const std::uint32_t frame : seen_.contacts) {
      if (seen_.was_swept && !is_small_contact(seen_, frame)) continue;
      add_responses(frame, least);
    }
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (seen_.good[i] != 0 && is_dead(i)) accuse(i);
    }
  }

  /// Adds the responses of the sensels whose neighbours carry `least` counts in a frame.
  void add_responses(std::uint32_t frame, double least) {
    const LyingSignals signals(seen_, frame);
    for (std::uint32_t row = 0; row < seen_.rows; ++row) {
      for (std::uint32_t col = 0; col < seen_.cols; ++col) {
        const std::size_t i = seen_.sensel(LineAxis::rows, row, col);
        if (seen_.good[i] == 0) continue;
        const double expected = seen_.was_swept ? signals.least_under_small_contact(row, col)
                                                : signals.least_under_contact(row, col);
        if (expected > std::max(least, kTestNoise * seen_.noise_of(i))) {
          responses_[i].add(signals.of(i), expected);
        }
      }
    }
  }

  [[nodiscard]] bool is_tested(std::size_t sensel) const {
    return responses_[sensel].is_tested(seen_.noise_of(sensel));
  }
  [[nodiscard]] bool is_dead(std::size_t sensel) const {
    return (seen_.was_swept || seen_.touched[sensel] == 0) &&
           responses_[sensel].is_below(dead_response_, seen_.noise_of(sensel));
  }

  /// The sensels of a line by what was found of them.
  struct LineCount {
    std::size_t faulty = 0;
    std::size_t dead = 0;
    std::size_t silent = 0;
    std::size_t sound = 0;
    std::size_t present = 0;
    double most = 0;  ///< response

    [[nodiscard]] bool is_dead() const {
      if (most > kMostDeadResponse) return false;
      const double least = std::max(3.0, kDeadLineShare * static_cast<double>(present));
      return (5 * silent >= 4 * present && static_cast<double>(faulty) >= least) ||
             (20 * sound <= present && static_cast<double>(dead) >= least);
    }
  };

  void count(std::size_t sensel, LineCount& line) const {
    const auto& verdict = seen_.verdicts[sensel];
    if (verdict == SenselFault::absent && read(sensel).lowest != 0) return;
    ++line.present;
    const bool is_faulty =
        verdict && *verdict != SenselFault::saturated && *verdict != SenselFault::noisy;
    line.faulty += is_faulty ? 1U : 0U;
    line.dead += verdict == SenselFault::unresponsive ? 1U : 0U;
    line.silent += is_faulty || seen_.constant[sensel] != 0 ? 1U : 0U;
    line.sound += !is_faulty && seen_.touched[sensel] > 0 ? 1U : 0U;
    if (is_tested(sensel)) line.most = std::max(line.most, responses_[sensel].ratio());
  }

  void report_lines(LineAxis axis, ArrayFault fault, Diagnosis& found) {
    const std::size_t length = seen_.kept.sensels() / seen_.lines(axis);
    for (std::size_t line = 0; line < seen_.lines(axis); ++line) {
      LineCount counted;
      for (std::size_t along = 0; along < length; ++along) {
        count(seen_.sensel(axis, line, along), counted);
      }
      if (!counted.is_dead()) continue;
      for (std::size_t along = 0; along < length; ++along) {
        const std::size_t i = seen_.sensel(axis, line, along);
        accuse(i);
        in_dead_line_[i] = 1;
      }
      ArrayFinding finding = {.fault = fault, .lines = {static_cast<std::uint32_t>(line)}};
      finding.figure = 100 * counted.most;
      add(found, std::move(finding));
    }
  }

  void report_sensels(ArrayFault fault, Diagnosis& found) {
    ArrayFinding finding = {.fault = fault};
    std::vector<double> means;
    std::vector<double> noises;
    double most = 0;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
      if (!seen_.verdicts[i] || in_dead_line_[i] != 0 || finding_of(*seen_.verdicts[i]) != fault) {
        continue;
      }
      finding.sensels.push_back(seen_.place(i));
      means.push_back(read(i).mean);
      noises.push_back(seen_.noise[i]);
      if (is_tested(i)) most = std::max(most, responses_[i].ratio());
    }
    if (finding.sensels.empty()) return;
    finding.figure = fault == ArrayFault::dead    ? 100 * most
                     : fault == ArrayFault::noisy ? median(noises) / seen_.typical_noise
                                                  : median(means);
    add(found, std::move(finding));
  }

  Examination& seen_;
  double dead_response_ = kDeadResponse;
  std::vector<SenselResponse> responses_;
  std::vector<std::uint8_t> in_dead_line_;
};

}  // namespace

void find_odd_readings(Examination& seen, const Diagnosis& found) {
  constexpr double kIdleAtFullScale = 0.9;
  const bool idles_there =
      found.polarity == Polarity::falls || found.idle_counts > kIdleAtFullScale * seen.full_scale;
  std::vector<SenselEvidence> evidence;
  for (std::size_t i = 0; i < seen.kept.sensels(); ++i) {
    evidence.push_back({seen.read[i], seen.idle[i], seen.noise[i]});
    if (idles_there) evidence.back().read.saturated = 0;
  }
  const SenselJudge judge(std::move(evidence), seen.frames_with_readings, {});
  for (std::size_t i = 0; i < seen.kept.sensels(); ++i) {
    seen.verdicts.push_back(judge.verdict(i));
    if (seen.verdicts.back() == SenselFault::noisy && seen.noisy[i] == 0) {
      seen.verdicts.back().reset();
    }
    seen.good[i] = seen.verdicts.back() ? 0 : 1;
  }
}

void find_faulty_sensels(Examination& seen, Diagnosis& found) {
  NeighbourVerdicts verdicts(seen);
  // Shear unloads some sensels of a pillar, so that its neighbours do not tell.
  if (!may_have_pillars(found) && !seen.is_out_of_order && !found.is_no_force()) {
    verdicts.judge((std::max(found.row_crosstalk_percent.value_or(0), 0.0) +
                    std::max(found.column_crosstalk_percent.value_or(0), 0.0)) /
                   100);
  }
  verdicts.report(found);
}

}  // namespace pillarfield
