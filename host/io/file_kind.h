#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/input_file.h"

namespace pillarfield {

/// The extension of a file name in lower case, ".csv"; empty if it has none.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

/// True if the extension is that of HDF5.
[[nodiscard]] bool is_hdf5_name(const std::filesystem::path& path);

/// The files of a series: those given, and those of folders, in natural order of their names, in
/// which frame_2 comes before frame_10. Hidden files, folders within folders and metadata.yaml of a
/// ROS 2 bag are left out. Throws Error if a folder holds no files, or several kinds.
[[nodiscard]] std::vector<std::filesystem::path> series_files(
    const std::vector<std::filesystem::path>& paths);

struct SourceFormat;  // io/frame_source.h

/// The kind of a file by its first bytes, whatever its name.
enum class FileKind : std::uint8_t {
  hdf5,
  frames,  ///< a SourceFormat
  other
};

struct DetectedFormat {
  FileKind kind = FileKind::other;
  const SourceFormat* frames = nullptr;  ///< set for FileKind::frames
};

/// Throws Error if the file is empty or cannot be read.
[[nodiscard]] DetectedFormat detect_format(const InputFile& file);
[[nodiscard]] inline FileKind kind_of(const std::filesystem::path& path) {
  return detect_format(InputFile(path)).kind;
}

/// State in which the last writer of an HDF5 file left it.
enum class WriterState : std::uint8_t {
  closed,     ///< closed cleanly
  swmr,       ///< killed or still writing in SWMR mode: flushed frames are readable
  abandoned,  ///< killed or still writing in another mode: nothing can be read
};

/// Reads the consistency flags of an HDF5 file's superblock (HDF5 file format, section II.A).
[[nodiscard]] WriterState writer_state(const InputFile& file);

}  // namespace pillarfield
