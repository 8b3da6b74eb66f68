#include "streams/source/sessions.h"

#include <algorithm>
#include <utility>

namespace pillarfield {

bool Sessions::was_replaced(std::uint64_t session) const {
  const auto kept = std::min<std::uint64_t>(replacements_, replaced_.size());
  const auto* const end = replaced_.begin() + kept;
  return std::find(replaced_.begin(), end, session) != end;
}

Sessions::Kind Sessions::classify(std::uint64_t session, std::chrono::nanoseconds arrived) {
  if (known_ && session != current_) {
    if (was_replaced(session) && arrived - heard_ < std::chrono::seconds(1)) return Kind::replaced;
    replaced_[replacements_++ % replaced_.size()] = current_;
  }
  heard_ = arrived;
  const bool started = std::exchange(known_, true) && session != current_;
  current_ = session;
  return started ? Kind::started : Kind::current;
}

double SensorClock::seconds(std::uint64_t time_ns, std::chrono::nanoseconds arrived,
                            bool restarted) {
  constexpr std::uint64_t kMostAheadNs = 1'000'000'000;
  const std::uint64_t before_ns = std::exchange(last_ns_, time_ns);
  const auto host =
      static_cast<std::uint64_t>(std::max<std::int64_t>((arrived - last_arrived_).count(), 0));
  last_arrived_ = arrived;
  if (!std::exchange(started_, true)) return 0;
  const bool comparable = !restarted && time_ns != 0 && before_ns != 0;
  const bool jumped =
      comparable && (time_ns < before_ns || time_ns - before_ns > host + kMostAheadNs);
  if (jumped) ++jumps_;
  // At least 1 ns, since files of frames need times that rise.
  elapsed_ns_ += std::max<std::uint64_t>(comparable && !jumped ? time_ns - before_ns : host, 1);
  return static_cast<double>(elapsed_ns_) * 1e-9;
}

}  // namespace pillarfield
