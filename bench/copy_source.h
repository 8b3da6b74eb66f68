#pragma once

#include <cstdint>
#include <string>

#include "bench/variants.h"

namespace pillarfield::bench {

/// How a copy kernel stores what it writes.
enum class CopyStores : std::uint8_t {
  cached,     ///< as any program does
  streaming,  ///< past the caches, where the compiler of the device knows how
};

/// OpenCL C of the kernels `copy_streams`, which reads and writes all of `streams` and does nothing
/// else that takes time, and `empty`. With 16 lanes a work-item copies a row of pillars, with one a
/// pillar, as solve_frame of that many lanes.
///
/// The bits of all that is read for as many pillars as are copied at once are folded by exclusive
/// or into one word for each, which is what every result plane gets, and the status bytes folded
/// once more: each bit that is read moves one value of every plane.
std::string copy_source(const Streams& streams, int lanes, CopyStores stores);

/// Floats from one plane to the next in the buffers of calibration and results: whole pages.
constexpr std::uint64_t plane_pitch(std::uint64_t values) { return (values + 1023) / 1024 * 1024; }

}  // namespace pillarfield::bench
