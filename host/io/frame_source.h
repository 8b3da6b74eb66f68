#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "pillarfield/recording.h"

namespace pillarfield {

/// A file format of frames other than HDF5, defined beside its source and listed in
/// frame_source.cpp.
struct SourceFormat {
  const char* name = "";  ///< "Tekscan ASCII export"
  /// Whether a file has the format, by its first 4096 bytes.
  bool (*recognises)(std::string_view head) = nullptr;
  std::unique_ptr<FrameSource> (*open)(const std::filesystem::path& path) = nullptr;
};

[[nodiscard]] std::span<const SourceFormat> source_formats();

/// The format of a file by its first 4096 bytes; null if unknown.
[[nodiscard]] const SourceFormat* source_format(std::string_view head);

}  // namespace pillarfield
