// Sections of a scene with files of their own.

#pragma once

#include <filesystem>

#include "pillarfield/scene.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

/// Reads the section [surface] of a scene, if present: the shape of the skin and how it bends.
/// `folder` is that of relative paths of height maps. Throws Error as TomlSection does.
void read_surface(TomlSection section, const std::filesystem::path& folder, Scene& scene);

/// Reads a [[indenter]] of a scene with this layout. Relative height map paths are relative to
/// `folder`; the file is not opened. Throws Error.
[[nodiscard]] Indenter read_indenter(TomlSection& section, const std::filesystem::path& folder,
                                     SkinLayout layout);

/// Reads the key `height_map`: a .npy file, relative to `folder`. Throws Error.
[[nodiscard]] std::filesystem::path read_height_map_path(TomlSection& section,
                                                         const std::filesystem::path& folder);

}  // namespace pillarfield
