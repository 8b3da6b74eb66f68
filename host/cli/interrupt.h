#pragma once

#include <cstdint>
#include <filesystem>

#include "pillarfield/interrupt.h"

namespace pillarfield::cli {

/// Throws Error after an interrupt: `frames` are done and may be in `output` + ".part".
void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output);

/// Throws Error after an interrupt of work that writes its output at the end.
void stop_if_interrupted_before(const std::filesystem::path& output);

}  // namespace pillarfield::cli
