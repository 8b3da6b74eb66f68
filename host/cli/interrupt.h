#pragma once

#include <cstdint>
#include <filesystem>

namespace pillarfield::cli {

/// From now on Ctrl-C and SIGTERM are noted instead of ending the process; a second one ends it.
void catch_interrupts();

/// Whether an interrupt was noted.
[[nodiscard]] bool is_interrupted();

/// Throws Error where an interrupt was noted: `frames` are done, and what is written under the name
/// of `output` + ".part" may hold them.
void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output);

/// The same for work that writes nothing before its end.
void stop_if_interrupted_before(const std::filesystem::path& output);

}  // namespace pillarfield::cli
