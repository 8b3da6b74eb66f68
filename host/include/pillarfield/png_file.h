#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"
#include "pillarfield/rgb_picture.h"

namespace pillarfield {

/// Writes a picture as PNG. Throws Error if it has no pixels, or the file cannot be written or
/// replaced.
void write_png(const std::filesystem::path& path, const RgbPicture& picture, Replace replace);

}  // namespace pillarfield
