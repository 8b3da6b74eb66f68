#pragma once

#include <filesystem>

#include "pillarfield/scene.h"
#include "simulation/scene/toml_section.h"

namespace pillarfield {

/// Reads the section [surface] of a scene, if present: the shape of the skin and how it bends.
/// `folder` is that of relative paths of height maps. Throws Error as TomlSection does.
void read_surface(TomlSection section, const std::filesystem::path& folder, Scene& scene);

}  // namespace pillarfield
