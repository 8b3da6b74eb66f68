#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "io/file_source.h"

namespace pillarfield {

/// A file format of frames other than HDF5, defined beside its source and listed in
/// frame_source.cpp.
struct SourceFormat {
  const char* name = "";  ///< "Tekscan ASCII export"
  /// Whether a file has the format, by its first 4096 bytes.
  bool (*recognises)(std::string_view head) = nullptr;
  std::unique_ptr<FileSource> (*open)(const std::filesystem::path& path,
                                      const ReadOptions& options) = nullptr;
};

[[nodiscard]] std::span<const SourceFormat> source_formats();

/// The format of a file by its first 4096 bytes; null if unknown.
[[nodiscard]] const SourceFormat* source_format(std::string_view head);

/// Throws Error if the options name an array, for a file that has only one.
void refuse_dataset(const std::filesystem::path& path, const ReadOptions& options);

/// Throws Error if the options give size, axes or columns of the frames, for a file that states
/// them.
void refuse_layout(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pillarfield
