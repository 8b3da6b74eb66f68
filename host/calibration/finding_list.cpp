#include "calibration/finding_list.h"

#include <algorithm>
#include <utility>

namespace pillarfield {

const char* name_of(SenselFault fault) {
  switch (fault) {
    case SenselFault::not_a_number:
      return "not a number";
    case SenselFault::absent:
      return "absent";
    case SenselFault::saturated:
      return "saturated";
    case SenselFault::stuck:
      return "stuck";
    case SenselFault::noisy:
      return "noisy";
    case SenselFault::unresponsive:
      return "unresponsive";
    case SenselFault::unequal:
      return "unequal";
    case SenselFault::unknown:
      break;
  }
  return "unknown";
}

FindingList::FindingList(std::vector<std::uint8_t> mask, const FrameStatistics& statistics)
    : statistics_(statistics), mask_(std::move(mask)) {
  if (mask_.empty()) mask_.assign(statistics.skin().sensels(), 1);
}

std::size_t FindingList::count_good() const {
  return static_cast<std::size_t>(std::count(mask_.begin(), mask_.end(), std::uint8_t{1}));
}

std::vector<std::uint8_t> FindingList::mask_plane() const {
  return count_good() == mask_.size() ? std::vector<std::uint8_t>() : mask_;
}

void FindingList::note(std::size_t sensel, SenselFault fault, bool masked) {
  const std::uint32_t cols = statistics_.skin().cols;
  findings_.push_back({static_cast<std::uint32_t>(sensel / cols),
                       static_cast<std::uint32_t>(sensel % cols), fault, masked,
                       statistics_.sensels()[sensel].mean});
  if (masked) mask_[sensel] = fault == SenselFault::absent ? kAbsent : std::uint8_t{0};
}

}  // namespace pillarfield
