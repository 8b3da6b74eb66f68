#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Largest filtered chunk that is read, bytes.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{128} << 20;

/// Storage layout of a dataset.
struct Storage {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;         ///< empty: not chunked
  std::vector<H5Z_filter_t> filters;  ///< in the order in which they were applied
  bool is_filtered = false;
  bool is_checked = true;  ///< its filters are known, so require_whole_chunks() can judge them
  std::size_t value_bytes = 0;
  bool is_filled = false;  ///< chunks that were never written read as its fill value

  [[nodiscard]] bool holds_values() const;
  [[nodiscard]] double chunk_bytes() const;  ///< without filters

  /// Bytes of all chunks that one frame lies in, without filters.
  [[nodiscard]] double layer_bytes() const;
};

/// Reads the layout. Throws Error if the dataset is not an array, lies in other files, or has
/// filtered chunks above kMaxChunkBytes.
[[nodiscard]] Storage storage_of(const File& file, const Handle& dataset, const std::string& name);

/// Throws Error if the file is shorter than the dataset claims or lacks chunks of it, so that a
/// damaged header causes no endless allocation and lost readings do not become zeros. Chunks of an
/// unclosed file are not counted. With `may_lack_chunks`, absent chunks of a dataset with a fill
/// value are as if they held it.
void require_stored(const File& file, const Handle& dataset, const std::string& name,
                    const Storage& storage, bool may_lack_chunks = false);

/// Throws Error if a chunk of a layer has another size
/// behind its filters than the layout states: HDF5 reads memory of the process in place of bytes
/// that lack. Absent chunks pass. Inflates each chunk once, into nothing.
void require_whole_chunks(const std::filesystem::path& path, bool trusted, const Handle& dataset,
                          const std::string& name, const Storage& storage, std::uint64_t layer);

}  // namespace pillarfield::hdf5
