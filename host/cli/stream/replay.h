#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pillarfield/frame_stream.h"
#include "pillarfield/read_options.h"

namespace pillarfield::cli {

/// True if the name of the file ends in .toml.
[[nodiscard]] bool is_scene(const std::string& file);

/// Streams a scene, or a recording or other file of frames, at its own pace or at `rate_hz`; again
/// and again if `repeat`; if `drops_late`, without frames that are more than four periods late.
/// Frames of a scene are simulated into memory first. Throws Error where the file cannot be read,
/// has no frames, or its times do not rise; returns null if interrupted meanwhile.
[[nodiscard]] std::unique_ptr<FrameStream> replayed_file(const std::string& file,
                                                         const ReadOptions& options,
                                                         std::optional<double> rate_hz, bool repeat,
                                                         bool drops_late, bool quiet);

}  // namespace pillarfield::cli
