#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/hdf5/driver.h"
#include "io/hdf5/handle.h"
#include "pillarfield/output_file.h"

namespace pillarfield::hdf5 {

/// An open HDF5 file, with its path for messages.
struct File {
  std::filesystem::path path;
  Handle id;
  std::shared_ptr<WriteStatus> write_status;  ///< set for created files
  bool unclosed = false;                      ///< its writer was killed or is still writing
  bool trusted = false;                       ///< see open_to_read
  Handle flushed_bytes;                       ///< set after start_appending(): see flush()
  Handle flushed_frames;                      ///< likewise
  /// Frames that the writer of an unclosed file has flushed. Datasets may be longer: HDF5 would
  /// read those of their chunks that are not in the file as zeros.
  std::uint64_t readable_frames = std::numeric_limits<std::uint64_t>::max();
};

/// Opens a file for reading, as a SWMR reader if its writer has not closed it; `input` may be
/// closed afterwards. Unless it is `trusted`, datasets refuse frames above kMostUntrustedValues.
[[nodiscard]] File open_to_read(const InputFile& input, bool trusted);

/// The root attribute `format`: "" if absent, unset if the file cannot be read as HDF5.
[[nodiscard]] std::optional<std::string> format_of(const std::filesystem::path& path);

/// Returns the root attribute `version`. Throws Error unless it is 1 to `newest`, and `format` as
/// given.
int require_format(const File& file, std::string_view format, int newest);

/// Creates an HDF5 file in an empty output, which must stay open. Flushed data survive the death of
/// the process. Create groups, attributes and datasets before start_appending(); after it, datasets
/// can only be extended.
[[nodiscard]] File create(const OutputFile& output);
void start_appending(File& file);

void flush(const File& file);

/// After start_appending(): flushes, then notes the file's size and that its datasets have so many
/// `frames`. open_to_read() refuses an unclosed file that became shorter, whose missing chunks HDF5
/// would read as zeros, and gives readers the frames.
void flush(const File& file, std::uint64_t frames);

/// Closes a created file whose datasets are closed. Throws Error if a write failed.
void close(File& file);

/// Properties for creating objects of a kind, H5P_DATASET_CREATE or another, without their times of
/// change: files with the same contents are then equal byte for byte.
[[nodiscard]] Handle creation_properties(const File& file, hid_t kind);

/// Creates a group whose parents exist.
[[nodiscard]] Handle create_group(const File& file, const char* name);

/// True if an object with this absolute path exists; its groups may be absent too. Throws Error if
/// a link on the path leads to another file or to nothing.
[[nodiscard]] bool exists(const File& file, std::string_view path);

/// Opens the group or dataset with this absolute path. Throws Error as exists() does, and if it is
/// absent.
[[nodiscard]] Handle open_object(const File& file, const char* path);

}  // namespace pillarfield::hdf5
