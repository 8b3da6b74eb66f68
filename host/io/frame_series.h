#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "io/file_source.h"

namespace pillarfield {

using OpenFile =
    std::function<std::unique_ptr<FileSource>(const std::filesystem::path&, const ReadOptions&)>;

/// Files of one or several frames as one source, which has their frames one after another, and has
/// one of them open at a time. `open` opens one of them. Throws Error if one differs from the first
/// in size, layout, constants or calibration.
[[nodiscard]] std::unique_ptr<FileSource> frame_series(std::vector<std::filesystem::path> files,
                                                       const ReadOptions& options, OpenFile open);

}  // namespace pillarfield
