#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace pillarfield {

struct SourceFormat;  // io/frame_source.h

/// What a file is, told by its first bytes and never by its name.
enum class FileKind : std::uint8_t {
  hdf5,
  frames,  ///< of a SourceFormat
  other
};

struct FileLook {
  FileKind kind = FileKind::other;
  const SourceFormat* frames = nullptr;  ///< with FileKind::frames
};

/// Throws Error where `path` is no regular file, is empty or cannot be read.
[[nodiscard]] FileLook look_at(const std::filesystem::path& path);
[[nodiscard]] inline FileKind kind_of(const std::filesystem::path& path) {
  return look_at(path).kind;
}

/// How the last writer of an HDF5 file left it.
enum class WriterState : std::uint8_t {
  closed,     ///< cleanly
  swmr,       ///< killed or still writing, in the mode that keeps flushed frames readable
  abandoned,  ///< killed or still writing in another mode: nothing can be read
};

/// Reads the consistency flags of an HDF5 file's superblock (HDF5 file format, section II.A).
[[nodiscard]] WriterState writer_state(const std::filesystem::path& path);

}  // namespace pillarfield
