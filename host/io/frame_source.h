#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_source.h"

namespace pillarfield {

/// A file format of frames other than HDF5, defined beside its source and listed in
/// frame_source.cpp.
struct SourceFormat {
  const char* name = "";  ///< "Tekscan ASCII export"
  /// True if a file has the format, by its first 4096 bytes.
  bool (*recognises)(std::string_view head) = nullptr;
  std::unique_ptr<FileSource> (*open)(const std::filesystem::path& path,
                                      const ReadOptions& options) = nullptr;
};

[[nodiscard]] std::span<const SourceFormat> source_formats();

/// The format of a file by its first 4096 bytes; null if unknown.
[[nodiscard]] const SourceFormat* source_format(std::string_view head);

[[nodiscard]] std::unique_ptr<FileSource> open_source(const std::filesystem::path& path,
                                                      const ReadOptions& options);

/// Files of frames as one source. Throws Error if one differs from the first in size, layout,
/// constants or calibration.
[[nodiscard]] std::unique_ptr<FileSource> frame_series(std::vector<std::filesystem::path> files,
                                                       const ReadOptions& options);

/// Throws Error if a file or folder has a format that is known by its first bytes `head`, or by its
/// files, and is not read; its mend is a command that makes an .npy of it.
void refuse_foreign(const std::filesystem::path& path, std::string_view head);
/// The same for an archive of ZIP without arrays of NumPy.
[[noreturn]] void refuse_foreign_archive(const std::filesystem::path& path, bool is_workbook);

/// "run python3 -c "..."", with names in quotes in `code`: {0} the file, {1} the .npy, {2} the
/// file's folder, {3} a pattern of the files in it that end alike, {4} the file without its ending,
/// {5} an .npy of a part, {6} a .csv, {7} an .npz.
[[nodiscard]] std::string python_line(std::string_view code, const std::filesystem::path& path);

/// Throws Error if the options name an array, for a file that has only one.
void refuse_dataset(const std::filesystem::path& path, const ReadOptions& options);

/// Throws Error if the options give size, axes or columns of the frames, for a file that states
/// them.
void refuse_layout(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pillarfield
