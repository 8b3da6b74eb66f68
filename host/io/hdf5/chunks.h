#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/file.h"
#include "io/hdf5/filters.h"

namespace pillarfield::hdf5 {

/// Storage layout of a dataset.
struct Storage {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;  ///< empty: not chunked
  Filters filters;             ///< empty: unfiltered
  std::size_t value_bytes = 0;
  bool is_filled = false;  ///< chunks that were never written read as its fill value

  [[nodiscard]] bool holds_values() const;
  [[nodiscard]] double chunk_bytes() const;
};

/// Reads the layout. Throws Error if the dataset is not an array, lies in other files, or has
/// unsupported filters.
[[nodiscard]] Storage storage_of(const File& file, const Handle& dataset, const std::string& name);

/// Throws Error if the file is shorter than the dataset claims or lacks chunks of it, so that a
/// damaged header causes no endless allocation and lost readings do not become zeros. Chunks of an
/// unclosed file are not counted. With `may_lack_chunks`, absent chunks of a dataset with a fill
/// value are as if they held it.
void require_stored(const File& file, const Handle& dataset, const std::string& name,
                    const Storage& storage, bool may_lack_chunks = false);

/// Largest unfiltered chunk that is read, bytes.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{128} << 20;

/// Reads frames of a dataset [frames, rows, cols], [frames, values] or [frames] that is stored in
/// filtered chunks. Caches up to 32 MiB of inflated frames, at least one, so that a chunk of many
/// frames is not inflated for each of them.
class FilteredChunks {
 public:
  /// Throws Error if a chunk exceeds kMaxChunkBytes or the dataset has more than three dimensions.
  FilteredChunks(std::filesystem::path file, std::string name, const Storage& storage);

  /// Copies `count` frames from `first` on, in their stored type. Throws Error if a chunk is
  /// missing or damaged.
  void copy(const Handle& dataset, std::uint64_t first, std::uint64_t count, std::byte* frames);

  /// Reads the stored bytes of the first and the last chunk.
  void touch(const Handle& dataset) const;

 private:
  using Place = std::array<hsize_t, 3>;  // frame, row, column; absent dimensions have size 1

  void inflate_frames(const Handle& dataset, std::uint64_t wanted);
  void copy_chunk(const std::vector<std::byte>& chunk, const Place& start);
  [[nodiscard]] std::vector<std::byte> stored_chunk(const Handle& dataset, const Place& start,
                                                    std::uint32_t& skipped) const;

  std::filesystem::path file_;
  std::string name_;
  std::size_t rank_;
  Filters filters_;
  Place extent_{1, 1, 1};
  Place chunk_{1, 1, 1};
  std::size_t value_bytes_;
  std::size_t frame_bytes_;
  std::size_t chunk_bytes_;
  std::uint64_t first_ = 0;  // first inflated frame
  std::uint64_t end_ = 0;    // one past the last inflated frame
  std::vector<std::byte> frames_;
};

}  // namespace pillarfield::hdf5
