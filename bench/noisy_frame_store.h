#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "bench/noisy_frames.h"

namespace pillarfield::bench {

/// Frames of solve variants: of the bare uint8 sensor, whose copy all variants are compared with,
/// and of the last variant. Neighbouring variants share them, since they are large.
class NoisyFrameStore {
 public:
  /// Each series has `count` frames of a square skin.
  NoisyFrameStore(std::uint32_t pillars_a_side, std::size_t count)
      : pillars_a_side_(pillars_a_side), count_(count) {}

  const NoisyFrames& bare();

  /// Frames for a variant's plan, valid until a call with another type or another calibration.
  const NoisyFrames& of(const SolverPlan& plan);

 private:
  using Kind = std::pair<SenselType, bool>;  ///< type, calibrated
  std::uint32_t pillars_a_side_;
  std::size_t count_;
  std::optional<NoisyFrames> bare_;
  std::optional<NoisyFrames> last_;
  Kind last_kind_;
};

}  // namespace pillarfield::bench
