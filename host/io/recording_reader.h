#pragma once

#include <filesystem>
#include <memory>

#include "pillarfield/recording.h"

namespace pillarfield {

/// Opens a recording, format "pillarfield-recording" version 1.
[[nodiscard]] std::unique_ptr<FrameSource> open_recording(const std::filesystem::path& path);

}  // namespace pillarfield
