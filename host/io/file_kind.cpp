#include "io/file_kind.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "io/frame_source.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";

std::ifstream open_binary(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path.string(), std::strerror(errno), "check its permissions");
  return file;
}

/// Size of the open file, even if its name now refers to another one.
std::uint64_t size_of(std::ifstream& file) {
  file.seekg(0, std::ios::end);
  const std::streamoff end = file.tellg();
  return end < 0 ? 0 : static_cast<std::uint64_t>(end);
}

std::string bytes_at(std::ifstream& file, std::uint64_t offset, std::size_t count) {
  std::string bytes(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

/// Offset of the superblock: 0, 512, 1024, 2048 … if a user block precedes it.
std::optional<std::uint64_t> superblock_offset(std::ifstream& file, std::uint64_t size) {
  for (std::uint64_t offset = 0; offset < size; offset = offset == 0 ? 512 : 2 * offset) {
    if (bytes_at(file, offset, kSignature.size()) == kSignature) return offset;
  }
  return std::nullopt;
}

void require_regular_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw Error(path.string(), std::make_error_code(std::errc::no_such_file_or_directory).message(),
                "check its name");
  }
  if (std::filesystem::is_directory(status)) {
    throw Error(path.string(), "is a directory", "name a file in it");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(path.string(), "is not a regular file", "copy its content into a file first");
  }
}

}  // namespace

DetectedFormat detect_format(const std::filesystem::path& path) {
  require_regular_file(path);
  std::ifstream file = open_binary(path);
  const std::uint64_t size = size_of(file);
  if (size == 0) throw Error(path.string(), "is empty", "give a recording or a Tekscan export");
  if (superblock_offset(file, size)) return {FileKind::hdf5, nullptr};
  const SourceFormat* const frames = source_format(bytes_at(file, 0, 4096));
  return {frames != nullptr ? FileKind::frames : FileKind::other, frames};
}

WriterState writer_state(const std::filesystem::path& path) {
  std::ifstream file = open_binary(path);
  const auto offset = superblock_offset(file, size_of(file));
  if (!offset) return WriterState::closed;
  const std::string superblock = bytes_at(file, *offset, 12);
  constexpr std::size_t kVersionAt = 8;
  constexpr std::size_t kFlagsAt = 11;
  // Older superblocks have no flags.
  if (superblock.size() <= kFlagsAt || superblock[kVersionAt] < 3) return WriterState::closed;
  const auto flags = static_cast<unsigned char>(superblock[kFlagsAt]);
  if ((flags & 4u) != 0) return WriterState::swmr;
  return (flags & 1u) != 0 ? WriterState::abandoned : WriterState::closed;
}

}  // namespace pillarfield
