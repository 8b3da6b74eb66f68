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

/// A source of frames and those loaded into memory.
struct PaceFrames {
  std::string file;
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;
  std::uint64_t in_source = 0;  ///< number of frames in the file, at least one
  std::function<void(std::uint64_t index, FrameBuffer& frame)>
      make;                         ///< reads or simulates a frame
  std::vector<FrameBuffer> loaded;  ///< the first frames
};

/// Whether the name of the file ends in .toml.
[[nodiscard]] bool is_scene(const std::string& file);

/// Opens a scene, recording or Tekscan export without loading frames; prints its warnings to
/// standard error. Throws Error where it cannot be read or has no frames.
[[nodiscard]] PaceFrames open_pace_frames(const std::string& file, const ReadOptions& options);

/// Loads at most `most` frames of up to `memory_bytes` together. Throws Error where none fits.
void load(PaceFrames& frames, std::uint64_t most, std::uint64_t memory_bytes, bool quiet);

}  // namespace pillarfield::cli
