#include "io/hdf5/tiled_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace pillarfield::hdf5 {
namespace {

/// Wanted size of a tile, pillars. A square metre with 8 % of its pillars in contact takes 14 % of
/// the room of all values, with 32 it takes 21 %; smaller tiles cost time where all are in contact.
constexpr hsize_t kTile = 14;
constexpr hsize_t kMostPlaneBytes = 12 << 20;  ///< memory for the frames of a chunk
constexpr hsize_t kMostChunkFrames = 16;       ///< frames from flush to flush

/// Size of tiles that cover `size`.
hsize_t tile_of(hsize_t size) {
  const hsize_t tiles = std::max<hsize_t>(1, (size + kTile / 2) / kTile);
  return (size + tiles - 1) / tiles;
}

/// Frames of a chunk: a power of two.
hsize_t frames_of(hsize_t plane_bytes) {
  return std::bit_floor(std::clamp<hsize_t>(kMostPlaneBytes / plane_bytes, 1, kMostChunkFrames));
}

}  // namespace

TiledFrames::TiledFrames(const File& file, const char* name, hid_t type, hsize_t rows, hsize_t cols,
                         const void* fill)
    : path_(file.path),
      failure_(fmt::format("{} cannot be written", name)),
      write_status_(file.write_status),
      value_bytes_(H5Tget_size(type)),
      rows_(rows),
      cols_(cols),
      tile_rows_(tile_of(rows)),
      tile_cols_(tile_of(cols)) {
  const hsize_t tile_values = tile_rows_ * tile_cols_;
  chunk_frames_ = frames_of(rows * cols * value_bytes_);
  fill_.resize(chunk_frames_ * tile_values * value_bytes_);
  for (std::size_t at = 0; at < fill_.size(); at += value_bytes_) {
    std::memcpy(fill_.data() + at, fill, value_bytes_);
  }
  for (hsize_t row = 0; row < rows; row += tile_rows_) {
    for (hsize_t col = 0; col < cols; col += tile_cols_) {
      tiles_.push_back({row,
                        col,
                        std::min(tile_rows_, rows - row),
                        std::min(tile_cols_, cols - col),
                        false,
                        {}});
    }
  }
  create(file, name, type, fill);
}

void TiledFrames::create(const File& file, const char* name, hid_t type, const void* fill) {
  const hsize_t extent[] = {0, rows_, cols_};
  const hsize_t longest[] = {H5S_UNLIMITED, rows_, cols_};
  const hsize_t chunk[] = {chunk_frames_, tile_rows_, tile_cols_};
  const Handle space = own(H5Screate_simple(3, extent, longest), path_, failure_);
  const Handle layout = own(H5Pcreate(H5P_DATASET_CREATE), path_, failure_);
  require(H5Pset_chunk(layout.get(), 3, chunk), path_, failure_);
  require(H5Pset_fill_value(layout.get(), type, fill), path_, failure_);
  require(H5Pset_alloc_time(layout.get(), H5D_ALLOC_TIME_INCR), path_, failure_);
  dataset_ = own(
      H5Dcreate2(file.id.get(), name, type, space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
      path_, failure_);
}

/// Place of a row of the current frame in a tile's values.
std::byte* TiledFrames::row_in(Tile& tile, hsize_t row) const {
  const hsize_t frame = frames_ % chunk_frames_;
  return tile.values.data() + ((frame * tile_rows_ + row) * tile_cols_) * value_bytes_;
}

bool TiledFrames::is_filled(const std::byte* frame, const Tile& tile) const {
  for (hsize_t row = 0; row < tile.rows; ++row) {
    const std::byte* const values = frame + ((tile.row + row) * cols_ + tile.col) * value_bytes_;
    if (std::memcmp(values, fill_.data(), tile.cols * value_bytes_) != 0) return false;
  }
  return true;
}

void TiledFrames::put(const std::byte* frame, Tile& tile) {
  if (!tile.stored) {
    if (is_filled(frame, tile)) return;
    tile.values = fill_;
    tile.stored = true;
  }
  for (hsize_t row = 0; row < tile.rows; ++row) {
    std::memcpy(row_in(tile, row), frame + ((tile.row + row) * cols_ + tile.col) * value_bytes_,
                tile.cols * value_bytes_);
  }
}

void TiledFrames::append(const void* frame) {
  for (Tile& tile : tiles_) put(static_cast<const std::byte*>(frame), tile);
  ++frames_;
  if (frames_ % chunk_frames_ == 0) flush();
}

void TiledFrames::flush() {
  if (flushed_ == frames_) return;
  const hsize_t extent[] = {frames_, rows_, cols_};
  require(H5Dset_extent(dataset_.get(), extent), path_, failure_);
  const hsize_t first = (frames_ - 1) / chunk_frames_ * chunk_frames_;
  const bool is_whole = frames_ % chunk_frames_ == 0;
  for (Tile& tile : tiles_) {
    if (!tile.stored) continue;
    const hsize_t start[] = {first, tile.row, tile.col};
    require(H5Dwrite_chunk(dataset_.get(), H5P_DEFAULT, 0, start, tile.values.size(),
                           tile.values.data()),
            path_, failure_);
    if (is_whole) tile.stored = false;
  }
  flushed_ = frames_;
  require_written(*write_status_, path_);
}

}  // namespace pillarfield::hdf5
