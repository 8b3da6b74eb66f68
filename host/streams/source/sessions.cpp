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

}  // namespace pillarfield
