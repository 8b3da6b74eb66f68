#pragma once

#include <filesystem>
#include <memory>

#include "pillarfield/recording.h"

namespace pillarfield {

/// Opens a Tekscan ASCII export in raw units (docs/formats.md); it is read whole into memory.
[[nodiscard]] std::unique_ptr<FrameSource> open_tekscan(const std::filesystem::path& path);

}  // namespace pillarfield
