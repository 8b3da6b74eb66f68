#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "pillarfield/read_options.h"

namespace pillarfield::fuzz {

/// Largest frame that is read, in sensels or pillars; a fuzzer needs many small files.
inline constexpr std::uint64_t kMaxRead = 1 << 20;

// Each function opens a file with the commands' reader and reads the first, the last and some other
// frames, with their truth, contacts and planes. It throws Error if the file is refused, as
// expected for damaged files; any other failure is a finding.

/// Reads a recording or a Tekscan export; also solves its frames in C++ and tracks their contacts.
void read_frames(const std::filesystem::path& path, const ReadOptions& options);

/// Reads plain data, also as frames that lie in lines and as a dataset `raw`, as read_frames()
/// does.
void read_plain(const std::filesystem::path& path, const ReadOptions& options);

/// Reads a force file; also compares its frames with themselves.
void read_forces(const std::filesystem::path& path, const ReadOptions& options);

/// Reads a calibration; also applies it to a skin of its size.
void read_calibration(const std::filesystem::path& path, const ReadOptions& options);

/// Reads a scene; also simulates the first and the last frame of a small one.
void read_scene(const std::filesystem::path& path, const ReadOptions& options);

/// Reads packets of a live source as from a pipe, and assembles their frames. Throws Error unless
/// all bytes belong to packets of one stream, and they make a frame.
void read_packets(const std::filesystem::path& path, const ReadOptions& options);

/// A kind of input, named after its folder in fuzz/corpus.
struct Target {
  std::string_view name;
  void (*read)(const std::filesystem::path& path, const ReadOptions& options);
};

inline constexpr std::array<Target, 7> kTargets = {{
    {"recording", read_frames},
    {"forces", read_forces},
    {"calibration", read_calibration},
    {"tekscan", read_frames},
    {"scene", read_scene},
    {"plain", read_plain},
    {"packets", read_packets},
}};

}  // namespace pillarfield::fuzz
