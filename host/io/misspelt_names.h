#pragma once

#include <string>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield {

/// Warnings of names in a recording that no reader knows and that resemble a known name which is
/// absent, one sentence each.
[[nodiscard]] std::vector<std::string> misspelt_names(const hdf5::File& file);

}  // namespace pillarfield
