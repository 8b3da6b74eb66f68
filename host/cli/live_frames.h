#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield::cli {

/// The first frames of a file, in memory.
struct LiveFrames {
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;
  std::vector<FrameBuffer> frames;  ///< at least one
  std::uint64_t in_source = 0;      ///< frames that the file has
};

/// Whether a file is a scene, by its name.
[[nodiscard]] bool is_scene(const std::string& file);

/// Simulates the frames of a scene, or reads those of a recording or Tekscan export: as many as
/// there are, `most` of them at most, and no more than fit into `memory_bytes`. Remarks of the file
/// go to standard error. Throws Error where it cannot be read, has no frames, or not one fits.
[[nodiscard]] LiveFrames load_live_frames(const std::string& file, std::uint64_t most,
                                          std::uint64_t memory_bytes, bool quiet);

}  // namespace pillarfield::cli
