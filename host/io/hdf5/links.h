#pragma once

#include <string_view>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Whether there is an object of this absolute path; its groups may be absent too. Throws Error
/// where a link on the way leads out of the file, as external links do, or nowhere.
[[nodiscard]] bool exists(const File& file, std::string_view path);

/// Opens the group or dataset of this absolute path; throws Error as exists() does, and where there
/// is none.
[[nodiscard]] Handle open_object(const File& file, const char* path);

}  // namespace pillarfield::hdf5
