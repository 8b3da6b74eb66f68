#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"
#include "calibration/doctor/lying_signals.h"

namespace pillarfield {
namespace {

/// Least share of sensels that must vary for a constant one to be stuck.
constexpr double kMostVary = 0.8;
/// Noise, counts, and frames from which a reading cannot be constant by chance.
constexpr double kVisibleNoise = 0.4;
constexpr std::uint32_t kVisibleFrames = 100;
/// SenselResponse relative to that of the neighbours below which a sensel is dead, and what is
/// added to it for each part of crosstalk.
constexpr double kDeadResponse = 0.12;
constexpr double kDeadCrosstalk = 3;
constexpr double kMostDeadResponse = 0.42;
/// The same where no small contact was swept over the array: large ones have edges and holes.
constexpr double kSilentResponse = 0.04;
/// Frames in which the neighbours of a sensel must be loaded, and the least precision of the
/// response.
constexpr std::uint32_t kLeastEvidence = 6;
constexpr double kLeastPrecision = 0.025;
/// Deviations by which a response of less precision must be below that of a dead sensel.
constexpr double kSureDead = 4;
/// Load of neighbours that tests a sensel, relative to the usual largest signal and to the noise.
constexpr double kTestShare = 0.2;
constexpr double kSweepShare = 0.08;
constexpr double kTestNoise = 4;
/// Share of a line's sensels that must be faulty, while none responds, for a dead line.
constexpr double kDeadLineShare = 0.15;

/// How a sensel responds where its neighbours are loaded.
struct SenselResponse {
  std::uint32_t frames = 0;
  double products = 0;
  double squares = 0;

  void add(double signal, double expected) {
    ++frames;
    products += signal * expected;
    squares += expected * expected;
  }
  [[nodiscard]] bool is_tested(double noise) const {
    return frames >= kLeastEvidence && deviation(noise) < kLeastPrecision;
  }
  [[nodiscard]] bool is_below(double most, double noise) const {
    if (is_tested(noise)) return ratio() < most;
    return frames >= kLeastEvidence && ratio() + kSureDead * deviation(noise) < most;
  }
  [[nodiscard]] double ratio() const { return products / squares; }
  [[nodiscard]] double deviation(double noise) const { return noise / std::sqrt(squares); }
};

/// The verdicts on sensels: kinds of ArrayFault, where there are any.
class SenselVerdicts {
 public:
  /// `idle_counts` is the usual reading without load.
  SenselVerdicts(Examination& seen, double idle_counts)
      : seen_(seen),
        idle_counts_(idle_counts),
        was_swept_(is_swept(seen, LineAxis::rows) || is_swept(seen, LineAxis::columns)),
        faults_(seen.kept.sensels()),
        responses_(seen.kept.sensels()) {}

  /// Judges sensels by their readings alone.
  void judge_readings() {
    judge_saturated();
    judge_constant();
  }

  /// Judges the others by those around them.
  void judge_by_neighbours(double crosstalk) {
    dead_response_ = was_swept_
                         ? std::min(kMostDeadResponse, kDeadResponse + kDeadCrosstalk * crosstalk)
                         : kSilentResponse;
    // The second time, dead neighbours do not count.
    for (int pass = 0; pass < 2; ++pass) judge_responses();
  }

  void report(Diagnosis& found) {
    report_lines(LineAxis::rows, ArrayFault::dead_row, found);
    report_lines(LineAxis::columns, ArrayFault::dead_column, found);
    for (const ArrayFault fault :
         {ArrayFault::absent, ArrayFault::dead, ArrayFault::stuck, ArrayFault::saturated}) {
      report_sensels(fault, found);
    }
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (faults_[i]) seen_.good[i] = 0;
      if (!faults_[i] && seen_.touched[i] == 0 && !is_tested(i)) {
        found.untouched.push_back(place(i));
      }
    }
  }

 private:
  [[nodiscard]] SenselPlace place(std::size_t sensel) const {
    return {static_cast<std::uint32_t>(sensel / seen_.cols),
            static_cast<std::uint32_t>(sensel % seen_.cols)};
  }
  [[nodiscard]] const SenselStatistics& read(std::size_t sensel) const {
    return seen_.statistics.sensels()[sensel];
  }
  void accuse(std::size_t sensel, ArrayFault fault) {
    faults_[sensel] = fault;
    seen_.good[sensel] = 0;
  }

  void judge_saturated() {
    if (idle_counts_ > 0.9 * seen_.full_scale) return;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      const SenselStatistics& sensel = read(i);
      if (2 * sensel.saturated > sensel.readings) accuse(i, ArrayFault::saturated);
    }
  }

  /// Judges sensels that read one value only, by the readings of the others without load.
  void judge_constant() {
    std::vector<float> others;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (seen_.constant[i] == 0) others.push_back(seen_.idle[i]);
    }
    const bool most_vary =
        static_cast<double>(others.size()) >= kMostVary * static_cast<double>(faults_.size());
    const bool shows_noise = most_vary && seen_.typical_noise > kVisibleNoise &&
                             seen_.statistics.frames() >= kVisibleFrames;
    const double far = 4 * seen_.typical_noise + 1;
    const bool zero_is_odd = most_vary && quantile(others, 0.02) > far;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (seen_.constant[i] == 0 || faults_[i]) continue;
      if (read(i).readings == 0 || (read(i).highest == 0 && zero_is_odd)) {
        accuse(i, ArrayFault::absent);
      } else if (shows_noise && read(i).lowest > far) {
        accuse(i, ArrayFault::stuck);
      }
    }
  }

  void judge_responses() {
    const double least = (was_swept_ ? kSweepShare : kTestShare) * seen_.contact_counts;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (seen_.good[i] != 0) responses_[i] = SenselResponse();
    }
    for (const std::uint32_t frame : seen_.contacts) {
      if (was_swept_ && !centre_of_small_contact(seen_, frame)) continue;
      const LyingSignals signals(seen_, frame);
      for (std::uint32_t row = 0; row < seen_.rows; ++row) {
        for (std::uint32_t col = 0; col < seen_.cols; ++col) {
          const std::size_t i = seen_.sensel_lying_at(row, col);
          if (seen_.good[i] == 0 || seen_.has_doubtful_place(row, col)) continue;
          const double expected = was_swept_ ? signals.least_under_small_contact(row, col)
                                             : signals.least_under_contact(row, col);
          if (expected > std::max(least, kTestNoise * noise(i))) {
            responses_[i].add(signals.of(i), expected);
          }
        }
      }
    }
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (seen_.good[i] != 0 && is_dead(i)) accuse(i, ArrayFault::dead);
    }
  }

  [[nodiscard]] double noise(std::size_t sensel) const {
    return std::max<double>(seen_.noise[sensel], seen_.typical_noise);
  }
  [[nodiscard]] bool is_tested(std::size_t sensel) const {
    return responses_[sensel].is_tested(noise(sensel));
  }
  [[nodiscard]] bool is_dead(std::size_t sensel) const {
    return responses_[sensel].is_below(dead_response_, noise(sensel));
  }

  void report_lines(LineAxis axis, ArrayFault fault, Diagnosis& found) {
    const std::size_t length = seen_.kept.sensels() / seen_.lines(axis);
    for (std::size_t line = 0; line < seen_.lines(axis); ++line) {
      std::size_t faulty = 0;
      std::size_t dead = 0;
      std::size_t silent = 0;
      std::size_t sound = 0;
      double most = 0;
      for (std::size_t along = 0; along < length; ++along) {
        const std::size_t i = seen_.sensel(axis, line, along);
        const bool is_faulty = faults_[i] && *faults_[i] != ArrayFault::saturated;
        faulty += is_faulty ? 1U : 0U;
        dead += faults_[i] == ArrayFault::dead ? 1U : 0U;
        silent += is_faulty || seen_.constant[i] != 0 ? 1U : 0U;
        sound += !is_faulty && (seen_.touched[i] > 0 || is_tested(i)) ? 1U : 0U;
        if (is_tested(i)) most = std::max(most, responses_[i].ratio());
      }
      const double least = std::max(3.0, kDeadLineShare * static_cast<double>(length));
      const bool is_line_dead =
          (5 * silent >= 4 * length && static_cast<double>(faulty) >= least) ||
          (20 * sound <= length && static_cast<double>(dead) >= least);
      if (!is_line_dead) continue;
      for (std::size_t along = 0; along < length; ++along) {
        const std::size_t i = seen_.sensel(axis, line, along);
        accuse(i, fault);
      }
      ArrayFinding finding = {.fault = fault, .lines = {static_cast<std::uint32_t>(line)}};
      finding.figure = 100 * most;
      add(found, std::move(finding));
    }
  }

  void report_sensels(ArrayFault fault, Diagnosis& found) {
    ArrayFinding finding = {.fault = fault};
    std::vector<double> means;
    double most = 0;
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (faults_[i] != fault) continue;
      finding.sensels.push_back(place(i));
      means.push_back(read(i).mean);
      if (is_tested(i)) most = std::max(most, responses_[i].ratio());
    }
    if (finding.sensels.empty()) return;
    finding.figure = fault == ArrayFault::dead ? 100 * most : median(means);
    add(found, std::move(finding));
  }

  Examination& seen_;
  double idle_counts_;
  bool was_swept_;
  double dead_response_ = kDeadResponse;
  std::vector<std::optional<ArrayFault>> faults_;
  std::vector<SenselResponse> responses_;
};

}  // namespace

void find_odd_readings(Examination& seen, Diagnosis& found) {
  SenselVerdicts(seen, found.idle_counts).judge_readings();
}

void find_faulty_sensels(Examination& seen, Diagnosis& found) {
  SenselVerdicts verdicts(seen, found.idle_counts);
  verdicts.judge_readings();
  // Shear unloads some sensels of a pillar, so that its neighbours do not tell.
  if (!may_have_pillars(found)) {
    verdicts.judge_by_neighbours((std::max(found.row_crosstalk_percent.value_or(0), 0.0) +
                                  std::max(found.column_crosstalk_percent.value_or(0), 0.0)) /
                                 100);
  }
  verdicts.report(found);
}

}  // namespace pillarfield
