#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/storage.h"

namespace pillarfield::hdf5 {

/// Largest chunk, as it is before its filters, that is read.
inline constexpr std::size_t kMostChunkBytes = std::size_t{128} << 20;

/// Reads frames of a dataset [frames, rows, cols], [frames, values] or [frames] that is stored in
/// chunks through filters. Frames inflated once stay in memory, up to 32 MiB of them or one frame,
/// so that one chunk of many frames is not inflated for each.
class FilteredChunks {
 public:
  /// Throws Error where a chunk is larger than kMostChunkBytes or the dataset has more dimensions.
  FilteredChunks(const std::filesystem::path& file, std::string name, const Storage& storage);

  /// Copies `count` frames from `first` on, as they are stored. Throws Error where a chunk of them
  /// is missing or damaged.
  void copy(const Handle& dataset, std::uint64_t first, std::uint64_t count, std::byte* frames);

  /// Reads the stored bytes of the first and of the last chunk.
  void touch(const Handle& dataset) const;

 private:
  using Place = std::array<hsize_t, 3>;  // frame, row, column; missing dimensions have the size 1

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
  std::uint64_t first_ = 0;  // frame of those inflated
  std::uint64_t end_ = 0;    // beyond the last of them
  std::vector<std::byte> frames_;
};

}  // namespace pillarfield::hdf5
