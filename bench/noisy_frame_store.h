#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "bench/noisy_frames.h"

namespace pillarfield::bench {

/// The frames of solve variants: those of the bare uint8 sensor, by whose copy all variants are
/// measured, and those that were wanted last. They are large, so neighbours among the variants
/// share them.
class NoisyFrameStore {
 public:
  /// Each series has `count` frames of a square skin.
  NoisyFrameStore(std::uint32_t pillars_a_side, std::size_t count)
      : pillars_a_side_(pillars_a_side), count_(count) {}

  const NoisyFrames& bare();

  /// For a plan of a variant; they stay until those of another type, or of a sensor calibrated
  /// otherwise, are asked for.
  const NoisyFrames& of(const SolverPlan& plan);

 private:
  using Kind = std::pair<SenselType, bool>;  ///< and whether calibrated
  std::uint32_t pillars_a_side_;
  std::size_t count_;
  std::optional<NoisyFrames> bare_;
  std::optional<NoisyFrames> last_;
  Kind last_kind_;
};

}  // namespace pillarfield::bench
