#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "pillarfield/read_options.h"

namespace pillarfield::fuzz {

// Each function opens one file with the reader that the commands use and reads what a command
// would: first, last and some frames, their truth, contacts and planes. Throws Error where the file
// is refused, which is the expected outcome for damaged files; anything else is a finding.

/// A recording or a Tekscan export; its frames are also solved in C++, and their contacts tracked.
void read_frames(const std::filesystem::path& path, const ReadOptions& options);

/// A force file; its frames are also compared with themselves.
void read_forces(const std::filesystem::path& path, const ReadOptions& options);

/// A calibration; it is also applied to a skin of its size.
void read_calibration(const std::filesystem::path& path, const ReadOptions& options);

/// A scene; a small one is also simulated, its first frame and its last.
void read_scene(const std::filesystem::path& path, const ReadOptions& options);

/// A kind of input, named like its folder in fuzz/corpus.
struct Target {
  std::string_view name;
  void (*read)(const std::filesystem::path& path, const ReadOptions& options);
};

inline constexpr std::array<Target, 5> kTargets = {{
    {"recording", read_frames},
    {"forces", read_forces},
    {"calibration", read_calibration},
    {"tekscan", read_frames},
    {"scene", read_scene},
}};

}  // namespace pillarfield::fuzz
