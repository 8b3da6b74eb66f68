#pragma once

#include <filesystem>

#include "core/toml_section.h"
#include "pillarfield/body.h"

namespace pillarfield {

/// Reads a [[body]]. `folder` comes before the path of a height map that is relative; the file is
/// not opened. Throws Error.
[[nodiscard]] Body read_body(TomlSection& section, const std::filesystem::path& folder);

}  // namespace pillarfield
