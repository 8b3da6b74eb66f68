#pragma once

#include <algorithm>
#include <optional>

namespace pillarfield::viewer {

/// Load at the top of the colour range: rises at once, and falls only after some seconds of less
/// than half of it. A pause without a touch changes nothing.
class LoadRange {
 public:
  static constexpr double kPatienceS = 8;

  /// Adds the largest force of a field; returns the new load if it changes.
  std::optional<float> add(double time_s, float most) {
    constexpr float kTouch = 0.05F;  // of the load; less is none, but noise
    if (!(most > 0)) return std::nullopt;
    if (most > load_) return settle(time_s, most);
    if (2 * most > load_) {
      begin(time_s);
    } else if (most > kTouch * load_) {
      touched_s_ += std::min(std::max(time_s - last_s_, 0.0), 1.0);
      lately_ = std::max(lately_, most);
    }
    last_s_ = time_s;
    return touched_s_ < kPatienceS ? std::nullopt : settle(time_s, lately_);
  }

 private:
  void begin(double time_s) {
    touched_s_ = 0;
    lately_ = 0;
    last_s_ = time_s;
  }

  std::optional<float> settle(double time_s, float load) {
    begin(time_s);
    load_ = load;
    return load;
  }

  float load_ = 0;        ///< N
  float lately_ = 0;      ///< largest load since it fell below half, N
  double touched_s_ = 0;  ///< time of touch below half the load
  double last_s_ = 0;
};

}  // namespace pillarfield::viewer
