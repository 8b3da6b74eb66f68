#pragma once

#include <cstdint>
#include <string>

#include "bench/variants.h"

namespace pillarfield::bench {

/// How a copy kernel goes about it, where the compiler of the device knows how; nobody can tell
/// beforehand what is fastest on a device.
struct CopyKind {
  const char* name;
  bool streaming;    ///< stores go past the caches
  bool prefetching;  ///< what is read later is asked for before
};
inline constexpr CopyKind kCopyKinds[] = {{"cached", false, false},
                                          {"streaming", true, false},
                                          {"prefetching", false, true},
                                          {"streaming_prefetching", true, true}};

/// OpenCL C of the kernels `copy_streams`, which reads and writes all of `streams` and does nothing
/// else that takes time, and `empty`. With 16 lanes a work-item copies a row of pillars, with one a
/// pillar, as solve_frame of that many lanes.
///
/// The bits of all that is read for as many pillars as are copied at once are folded by exclusive
/// or into one word for each, which is what every result plane gets, and the status bytes folded
/// once more: each bit that is read moves one value of every plane.
std::string copy_source(const Streams& streams, int lanes, const CopyKind& kind);

/// Values from one plane to the next in the buffers of calibration and results: whole pages.
constexpr std::uint64_t plane_pitch(std::uint64_t values) { return (values + 1023) / 1024 * 1024; }

}  // namespace pillarfield::bench
