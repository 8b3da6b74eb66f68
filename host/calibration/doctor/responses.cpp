#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Largest response of a dead and of a weak sensel, and the deviations of the logarithm of all
/// responses that either is below their median.
constexpr double kDead = 0.12;
constexpr double kWeak = 0.35;
constexpr double kFarBelow = 5;
/// The same deviation where too few sensels were tested, and its least value.
constexpr double kAssumedSpread = 0.5;
constexpr double kLeastSpread = 0.1;
constexpr std::size_t kEnoughTested = 10;
/// Least load that tests, in the usual largest signal.
constexpr double kTestingLoad = 0.12;
constexpr std::size_t kPlacesToTouch = 4;

/// Median response and where it is far below.
struct UsualResponse {
  double middle = 1;
  double far_below = std::exp(-kFarBelow * kAssumedSpread);

  explicit UsualResponse(std::vector<double> responses) {
    if (responses.size() < kEnoughTested) return;
    middle = median(responses);
    const double low = std::log(middle / std::max(quantile(responses, 0.1), 1e-3)) / 1.2816;
    for (double& each : responses) each = std::abs(std::log(std::max(each, 1e-3) / middle));
    const double spread = std::max({kLeastSpread, 1.4826 * median(responses), low});
    far_below = middle * std::exp(-kFarBelow * spread);
  }
};

ResponseWatch watch_responses(const Examination& seen) {
  ResponseWatch watch(seen.rows, seen.cols, seen.statistics.skin().has_pillars() ? 2 : 1);
  std::vector<float> least(seen.kept.sensels());
  for (std::size_t i = 0; i < least.size(); ++i) {
    least[i] =
        static_cast<float>(std::max(1.5 * seen.threshold(i), kTestingLoad * seen.contact_counts));
  }
  std::vector<float> signals;
  for (const std::uint32_t frame : seen.contacts) {
    const auto all = std::as_const(seen.kept).frame(frame);
    signals.assign(all.begin(), all.end());
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (seen.good[i] == 0) signals[i] = std::numeric_limits<float>::quiet_NaN();
    }
    watch.add(signals, least);
  }
  return watch;
}

void find_dead_lines(Examination& seen, const ResponseWatch& watch, LineAxis axis,
                     Diagnosis& found) {
  for (const std::uint32_t line : watch.dead_lines(axis)) {
    ArrayFinding finding = {
        .fault = axis == LineAxis::rows ? ArrayFault::dead_row : ArrayFault::dead_column,
        .lines = {line},
        .figure = 100 * watch.line_response(axis, line)};
    add(found, std::move(finding));
    for (std::size_t along = 0; along < seen.kept.sensels() / seen.lines(axis); ++along) {
      const std::size_t i = seen.sensel(axis, line, along);
      if (!seen.verdicts[i]) seen.verdicts[i] = SenselFault::unresponsive;
      seen.good[i] = 0;
    }
  }
}

/// Places of sensels, far from each other.
std::vector<SenselPlace> some_of(const std::vector<SenselPlace>& places, const Examination& seen) {
  const auto apart = static_cast<std::int64_t>(std::max({seen.rows, seen.cols, 8U}) / 4);
  std::vector<SenselPlace> some;
  for (const auto& [row, col] : places) {
    const bool is_apart = std::ranges::all_of(some, [&, row = row, col = col](const auto& other) {
      return std::abs(std::int64_t{row} - other.first) >= apart ||
             std::abs(std::int64_t{col} - other.second) >= apart;
    });
    if (is_apart && some.size() < kPlacesToTouch) some.emplace_back(row, col);
  }
  return some;
}

}  // namespace

void find_responses(Examination& seen, Diagnosis& found) {
  const ResponseWatch watch = watch_responses(seen);
  find_dead_lines(seen, watch, LineAxis::rows, found);
  find_dead_lines(seen, watch, LineAxis::columns, found);
  std::vector<double> responses;
  for (std::size_t i = 0; i < seen.good.size(); ++i) {
    const auto response = watch.response(i);
    if (seen.good[i] != 0 && response) responses.push_back(*response);
  }
  const UsualResponse usual(responses);
  ArrayFinding dead = {.fault = ArrayFault::dead};
  ArrayFinding weak = {.fault = ArrayFault::weak};
  for (std::size_t i = 0; i < seen.good.size(); ++i) {
    found.never_differ += seen.constant[i] != 0 ? 1U : 0U;
    if (seen.good[i] == 0) continue;
    const auto response = watch.response(i);
    if (!response && seen.touched[i] == 0 && seen.constant[i] == 0) {
      found.untouched.push_back(seen.place(i));
    }
    if (!response) continue;
    const double most = *response + 3 * watch.deviation(i, seen.noise_of(i));
    if (most > std::min(kWeak, usual.far_below)) continue;
    ArrayFinding& finding = *response < kDead ? dead : weak;
    finding.sensels.push_back(seen.place(i));
    finding.figure = std::max(finding.figure, 100 * *response);
    seen.good[i] = 0;
    if (*response < kDead) seen.verdicts[i] = SenselFault::unresponsive;
  }
  found.touch_here = some_of(found.untouched, seen);
  if (!dead.sensels.empty()) add(found, std::move(dead));
  if (!weak.sensels.empty()) add(found, std::move(weak));
}

}  // namespace pillarfield
