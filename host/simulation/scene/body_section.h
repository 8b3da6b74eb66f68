#pragma once

#include <filesystem>

#include "pillarfield/body.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

/// Reads a [[body]]. Relative height map paths are relative to `folder`; the file is not opened.
/// Throws Error.
[[nodiscard]] Body read_body(TomlSection& section, const std::filesystem::path& folder);

}  // namespace pillarfield
