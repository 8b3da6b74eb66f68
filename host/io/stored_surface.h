#pragma once

#include <optional>

#include "io/hdf5/file.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Creates the group /surface of recordings and force files: shape, radius, axis, heights.
void write_surface(const hdf5::File& file, const Surface& surface, const PillarLayout& pillars);

/// Reads the group /surface; unset if it is absent. Throws Error if it does not fit the pillars.
[[nodiscard]] std::optional<Surface> read_surface(const hdf5::File& file,
                                                  const PillarLayout& pillars);

}  // namespace pillarfield
