#pragma once

#include <string>
#include <vector>

#include "pillarfield/force_file.h"

namespace pillarfield::cli {

/// ForceFileReader::examine_parts() of `file`, with progress; throws Error after an interrupt.
[[nodiscard]] std::vector<LostPart> examined_parts(const ForceFileReader& reader,
                                                   const std::string& file, bool quiet);

}  // namespace pillarfield::cli
