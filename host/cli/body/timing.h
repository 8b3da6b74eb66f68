#pragma once

#include <cstddef>
#include <vector>

#include "pillarfield/whole_body.h"

namespace pillarfield::cli {

/// A frame of a body of which a share of the blocks changes, as packets of these and as whole
/// frames; medians, measured in turns.
struct BodyTiming {
  double share = 0;
  double changed_ms = 0;  ///< receive, solve, and sum the loads of what changed
  double whole_ms = 0;    ///< copy and solve whole frames; idle blocks are skipped
  std::size_t changed_bytes = 0;
  std::size_t whole_bytes = 0;
};

/// Times both for each share, (0, 1], of each patch's blocks: a rectangle in contact.
[[nodiscard]] std::vector<BodyTiming> time_body(const Device& device, const BodySkin& skin,
                                                const std::vector<double>& shares, bool quiet);

/// The largest share up to which changed blocks cost less time than whole frames, interpolated; 1
/// if they always do, 0 if never.
[[nodiscard]] double break_even(const std::vector<BodyTiming>& timings);

}  // namespace pillarfield::cli
