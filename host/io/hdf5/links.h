#pragma once

#include <string_view>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Whether an object with this absolute path exists; its groups may be absent too. Throws Error if
/// a link on the path leads to another file or to nothing.
[[nodiscard]] bool exists(const File& file, std::string_view path);

/// Opens the group or dataset with this absolute path. Throws Error as exists() does, and if it is
/// absent.
[[nodiscard]] Handle open_object(const File& file, const char* path);

}  // namespace pillarfield::hdf5
