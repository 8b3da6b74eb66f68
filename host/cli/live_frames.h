#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin.h"

namespace pillarfield::cli {

/// Frames of a file, as many as are wanted of them in memory.
struct LiveFrames {
  std::string file;
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;
  std::uint64_t in_source = 0;  ///< frames that the file has, at least one
  std::function<void(std::uint64_t index, FrameBuffer& frame)> make;  ///< reads or simulates one
  std::vector<FrameBuffer> loaded;                                    ///< the first of them
};

/// Whether a file is a scene, by its name.
[[nodiscard]] bool is_scene(const std::string& file);

/// Opens a scene, recording or Tekscan export; no frame is loaded yet. Warnings of the file go to
/// standard error. Throws Error where it cannot be read or has no frames.
[[nodiscard]] LiveFrames open_live_frames(const std::string& file, const ReadOptions& options);

/// Loads frames: as many as there are, `most` of them at most, and no more than fit into
/// `memory_bytes`. Throws Error where not one fits.
void load(LiveFrames& live, std::uint64_t most, std::uint64_t memory_bytes, bool quiet);

}  // namespace pillarfield::cli
