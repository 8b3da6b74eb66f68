#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// Frames whose mean is a rest, and those that are left out after a release.
constexpr std::size_t kRestFrames = 8;
constexpr std::size_t kSettling = 3;
/// Signal of a touch, in the usual largest one, and the share of a touch that a release leaves.
constexpr double kTouchSignal = 0.25;
constexpr float kReleased = 0.5F;
/// Least change of a rest: in the touch, in the noise of its mean, and in the changes of sensels
/// that were not touched.
constexpr double kLeastOfTouch = 0.05;
constexpr double kOverNoise = 6;
constexpr double kOverOthers = 6;
/// Releases that a sensel needs, and the share of them that must agree.
constexpr std::size_t kLeastReleases = 3;
constexpr double kAgreeing = 0.8;

using Signals = std::vector<float>;

/// Changes of a sensel's rest from before a touch to after it, counts.
struct RestChanges {
  std::size_t releases = 0;
  std::array<std::vector<double>, 2> of = {};  ///< up, down
};

/// Follows touches of the whole array: rest, touch, release, rest.
class RestSearch {
 public:
  explicit RestSearch(const Examination& seen) : seen_(seen) {
    for (std::size_t i = 0; i < seen.kept.sensels(); ++i) {
      least_.push_back(
          static_cast<float>(std::max(1.5 * seen.threshold(i), kTouchSignal * seen.usual_peak)));
    }
    for (std::size_t frame = 0; frame < seen.kept.frames(); ++frame) {
      add(std::as_const(seen.kept).frame(frame));
    }
  }

  [[nodiscard]] const std::map<std::size_t, RestChanges>& changes() const { return changes_; }

 private:
  void add(std::span<const float> signals) {
    recent_.push_back(signals);
    if (recent_.size() > kRestFrames) recent_.pop_front();
    ++since_release_;
    if (before_.empty()) {
      if (recent_.size() == kRestFrames) before_ = mean();
      return;
    }
    bool rises = false;
    bool is_released = true;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (!seen_.is_steady(i) || seen_.good[i] == 0) continue;
      const float above = signals[i] - before_[i];
      rises = rises || above > least_[i];
      if (peaks_.empty() || !(peaks_[i] > least_[i])) continue;
      is_released = is_released && above < kReleased * peaks_[i];
    }
    if (peaks_.empty()) {
      if (rises) {
        peaks_.assign(signals.size(), 0);
        since_release_ = 0;
      } else if (recent_.size() == kRestFrames) {
        before_ = mean();
      }
    }
    if (peaks_.empty()) return;
    if (!is_released || since_release_ == 0) {
      for (std::size_t i = 0; i < signals.size(); ++i) {
        peaks_[i] = std::max(peaks_[i], signals[i] - before_[i]);
      }
      since_release_ = 0;
      return;
    }
    if (since_release_ < kSettling + kRestFrames) return;
    end_touch();
  }

  /// Means of the recent frames.
  [[nodiscard]] Signals mean() const {
    Signals sums(recent_.front().size());
    for (const auto& signals : recent_) {
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += signals[i] / kRestFrames;
    }
    return sums;
  }

  void end_touch() {
    Signals after = mean();
    std::vector<double> others;
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (seen_.is_steady(i) && peaks_[i] < least_[i] / 2) others.push_back(after[i] - before_[i]);
    }
    const double common = others.empty() ? 0 : median(others);
    for (double& each : others) each = std::abs(each - common);
    const double spread = others.empty() ? 0 : 1.4826 * median(others);
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (!seen_.is_steady(i) || seen_.good[i] == 0 || peaks_[i] < least_[i]) continue;
      RestChanges& changes = changes_[i];
      ++changes.releases;
      const double change = after[i] - before_[i] - common;
      // Windows with a touch overrate the noise of touched sensels.
      const double noise = std::max<double>(seen_.jitter[i], seen_.typical_noise);
      const double least =
          std::max({kLeastOfTouch * peaks_[i], kOverNoise * noise * std::sqrt(2.0 / kRestFrames),
                    kOverOthers * spread * noise / seen_.typical_noise});
      if (std::abs(change) < least) continue;
      changes.of.at(change > 0 ? 0 : 1).push_back(std::abs(change));
    }
    before_ = std::move(after);
    peaks_.clear();
  }

  const Examination& seen_;
  std::vector<float> least_;  ///< of a touch, counts
  std::deque<std::span<const float>> recent_;
  Signals before_;  ///< rest before the touch
  Signals peaks_;   ///< of the touch beyond it; empty: nothing touches
  std::size_t since_release_ = 0;
  std::map<std::size_t, RestChanges> changes_;
};

}  // namespace

void find_rests(const Examination& seen, Diagnosis& found) {
  const RestSearch search(seen);
  for (const std::size_t way : {0U, 1U}) {
    ArrayFinding finding = {.fault = way == 0 ? ArrayFault::rest_after_release
                                              : ArrayFault::followed_baseline};
    std::vector<double> sizes;
    for (const auto& [sensel, changes] : search.changes()) {
      std::vector<double> agreeing = changes.of.at(way);
      if (agreeing.size() < kLeastReleases ||
          static_cast<double>(agreeing.size()) <
              kAgreeing * static_cast<double>(changes.releases)) {
        continue;
      }
      finding.sensels.push_back(seen.place(sensel));
      finding.releases = std::max(finding.releases, changes.releases);
      finding.seen = std::max(finding.seen, agreeing.size());
      sizes.push_back(median(agreeing));
    }
    if (sizes.empty()) continue;
    finding.figure = median(sizes);
    add(found, std::move(finding));
  }
}

}  // namespace pillarfield
