#pragma once

#include <filesystem>

#include "pillarfield/indenter.h"
#include "pillarfield/skin.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

/// Reads a [[indenter]] of a scene with this layout. Relative height map paths are relative to
/// `folder`; the file is not opened. Throws Error.
[[nodiscard]] Indenter read_indenter(TomlSection& section, const std::filesystem::path& folder,
                                     SkinLayout layout);

/// Reads the key `height_map`: a .npy file, relative to `folder`. Throws Error.
[[nodiscard]] std::filesystem::path read_height_map_path(TomlSection& section,
                                                         const std::filesystem::path& folder);

}  // namespace pillarfield
