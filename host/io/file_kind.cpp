#include "io/file_kind.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "io/frame_source.h"
#include "pillarfield/error.h"

namespace pillarfield {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return extension;
}

bool is_hdf5_name(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".h5" || extension == ".hdf5";
}

namespace {

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";

/// Offset of the superblock: 0, 512, 1024, 2048 … if a user block precedes it.
std::optional<std::uint64_t> superblock_offset(const InputFile& file) {
  for (std::uint64_t offset = 0; offset < file.size(); offset = offset == 0 ? 512 : 2 * offset) {
    if (file.text_at(offset, kSignature.size()) == kSignature) return offset;
  }
  return std::nullopt;
}

}  // namespace

DetectedFormat detect_format(const InputFile& file) {
  if (file.size() == 0) {
    throw Error(file.path().string(), "is empty", "give a recording or a Tekscan export");
  }
  if (superblock_offset(file)) return {FileKind::hdf5, nullptr};
  const SourceFormat* const frames = source_format(file.text_at(0, 4096));
  return {frames != nullptr ? FileKind::frames : FileKind::other, frames};
}

WriterState writer_state(const InputFile& file) {
  const auto offset = superblock_offset(file);
  if (!offset) return WriterState::closed;
  const std::string superblock = file.text_at(*offset, 12);
  constexpr std::size_t kVersionAt = 8;
  constexpr std::size_t kFlagsAt = 11;
  // Older superblocks have no flags.
  if (superblock.size() <= kFlagsAt || superblock[kVersionAt] < 3) return WriterState::closed;
  const auto flags = static_cast<unsigned char>(superblock[kFlagsAt]);
  if ((flags & 4u) != 0) return WriterState::swmr;
  return (flags & 1u) != 0 ? WriterState::abandoned : WriterState::closed;
}

}  // namespace pillarfield
