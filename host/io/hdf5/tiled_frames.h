#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Tiles of planes: squares, or for planes most of whose values are stored anyway, strips of whole
/// rows, which are fewer and lie in memory as in the file.
enum class Tiling { squares, strips };

/// A dataset [frames, rows, cols] that is extended frame by frame, in chunks of several frames of a
/// tile. A chunk all of whose values are the fill value takes no room in the file.
class TiledFrames {
 public:
  TiledFrames() = default;

  /// `type` is the type of the values in memory and in the file, `fill` one of them; `frames` how
  /// many will come, 0 if that is not known.
  TiledFrames(const File& file, const char* name, hid_t type, hsize_t rows, hsize_t cols,
              const void* fill, Tiling tiling = Tiling::squares, std::uint64_t frames = 0);

  /// Appends a frame; the file has it after the next flush().
  void append(const void* frame);

  /// Writes the frames appended so far to the file.
  void flush();

  void close() { (void)dataset_.close(); }

 private:
  /// Values of a tile in the frames of the current chunk.
  struct Tile {
    hsize_t row = 0;
    hsize_t col = 0;
    hsize_t rows = 0;  ///< inside the plane; the last tiles may be cut
    hsize_t cols = 0;
    bool stored = false;  ///< differs from the fill value in some frame
    std::vector<std::byte> values;
  };

  void create(const File& file, const char* name, hid_t type, const void* fill);
  void extend(std::uint64_t frames);
  [[nodiscard]] bool is_in_place(const Tile& tile) const;
  void write(const Tile& tile, std::uint64_t first, const std::byte* values);
  [[nodiscard]] std::byte* row_in(Tile& tile, hsize_t row) const;
  [[nodiscard]] bool is_filled(const std::byte* frame, const Tile& tile) const;
  void start(Tile& tile) const;
  void put(const std::byte* frame, Tile& tile);

  std::filesystem::path path_;
  std::string failure_;
  std::shared_ptr<WriteStatus> write_status_;
  Handle dataset_;
  std::size_t value_bytes_ = 0;
  hsize_t rows_ = 0;
  hsize_t cols_ = 0;
  hsize_t chunk_frames_ = 1;
  hsize_t tile_rows_ = 0;
  hsize_t tile_cols_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t flushed_ = 0;
  std::vector<std::byte> fill_;  ///< a chunk of fill values
  std::vector<Tile> tiles_;
};

}  // namespace pillarfield::hdf5
