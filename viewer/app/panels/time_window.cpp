#include "viewer/app/panels/time_window.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

Span last_of(const Span& whole, double seconds) {
  return {std::max(whole.from, whole.to - seconds), whole.to};
}

}  // namespace

Span TimeWindow::of(const Span& whole, double lasts_s) const {
  const bool live = lasts_s > 0;
  if (!chosen_) return live ? last_of(whole, lasts_s) : whole;
  if (live && at_end_) return last_of(whole, chosen_->to - chosen_->from);
  return *chosen_;
}

void TimeWindow::zoom(const Span& whole, double lasts_s, double at_s, double factor) {
  const Span now = of(whole, lasts_s);
  const double length = std::max((now.to - now.from) / factor, kLeastSeconds);
  if (length >= whole.to - whole.from) {
    if (lasts_s > 0) {
      choose(whole, whole.from, whole.to - whole.from);
    } else {
      reset();
    }
    return;
  }
  const double share = (at_s - now.from) / (now.to - now.from);
  choose(whole, at_s - share * length, length);
}

void TimeWindow::pan(const Span& whole, double lasts_s, double seconds) {
  const Span now = of(whole, lasts_s);
  choose(whole, now.from + seconds, now.to - now.from);
}

void TimeWindow::choose(const Span& whole, double from, double length) {
  constexpr double kAtEnd = 1e-3;
  const double latest = std::max(whole.to - length, whole.from);
  from = std::clamp(from, whole.from, latest);
  chosen_ = Span{from, from + length};
  at_end_ = from >= latest - kAtEnd * length;
}

}  // namespace pillarfield::viewer
