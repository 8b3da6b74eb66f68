#pragma once

#include <cstdint>
#include <filesystem>

#include "pillarfield/interrupt.h"

namespace pillarfield::cli {

/// Throws Error where an interrupt was noted: `frames` are done, and what is written under the name
/// of `output` + ".part" may hold them.
void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output);

/// The same for work that writes nothing before its end.
void stop_if_interrupted_before(const std::filesystem::path& output);

}  // namespace pillarfield::cli
