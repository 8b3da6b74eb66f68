#pragma once

#include <cstdint>
#include <string>

#include "bench/variants.h"

namespace pillarfield::bench {

/// A variant of the copy kernel; the fastest depends on the device. Ignored where the device's
/// compiler lacks the builtin.
struct CopyKind {
  const char* name;
  bool streaming;    ///< nontemporal stores
  bool prefetching;  ///< prefetches what it reads
};
inline constexpr CopyKind kCopyKinds[] = {{"cached", false, false},
                                          {"streaming", true, false},
                                          {"prefetching", false, true},
                                          {"streaming_prefetching", true, true}};

/// OpenCL C of the kernels `copy_streams`, which reads and writes all of `streams`, and `empty`. As
/// in solve_frame, a work-item copies a row of pillars with 16 lanes, one pillar with 1 lane.
///
/// The kernel folds the input of each lane by exclusive or into one word, stores the word to every
/// result plane, and folds it again for the status byte. So each input bit changes one value of
/// every plane, and no read can be optimised away.
std::string copy_source(const Streams& streams, int lanes, const CopyKind& kind);

/// Distance of the planes in the buffers of calibration and results, in values: whole pages.
constexpr std::uint64_t plane_pitch(std::uint64_t values) { return (values + 1023) / 1024 * 1024; }

}  // namespace pillarfield::bench
