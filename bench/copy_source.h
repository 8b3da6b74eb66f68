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
/// The bits of all that is read are folded into one word a pillar by exclusive or, which is what
/// every result plane and the status bytes get: each input bit moves every output.
std::string copy_source(const Streams& streams, int lanes, CopyStores stores);

/// Floats from one plane to the next in the buffers of calibration and results: whole pages.
constexpr std::uint64_t plane_pitch(std::uint64_t values) { return (values + 1023) / 1024 * 1024; }

}  // namespace pillarfield::bench
