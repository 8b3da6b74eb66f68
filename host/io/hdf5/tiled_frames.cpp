#include "io/hdf5/tiled_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace pillarfield::hdf5 {
namespace {

/// Wanted size of a square tile, pillars. A square metre with 8 % of its pillars in contact takes
/// 14 % of the room of all values, with 32 it takes 21 %; smaller tiles cost time.
constexpr hsize_t kTile = 14;
constexpr hsize_t kStripRows = 56;             ///< wanted
constexpr hsize_t kMostPlaneBytes = 12 << 20;  ///< memory for the frames of a chunk
constexpr hsize_t kMostChunkFrames = 16;       ///< frames from flush to flush
constexpr hsize_t kAloneBytes = 1 << 20;       ///< strips of larger planes hold one frame

/// Size of tiles that cover `size`.
hsize_t tile_of(hsize_t size, hsize_t wanted) {
  const hsize_t tiles = std::max<hsize_t>(1, (size + wanted / 2) / wanted);
  return (size + tiles - 1) / tiles;
}

/// Frames of a chunk, a power of two; chunks are stored whole.
hsize_t frames_of(hsize_t plane_bytes, Tiling tiling, std::uint64_t frames) {
  if (tiling == Tiling::strips && plane_bytes > kAloneBytes) return 1;
  const hsize_t most = frames == 0 || frames > kMostChunkFrames ? kMostChunkFrames : frames;
  return std::bit_floor(std::clamp<hsize_t>(kMostPlaneBytes / plane_bytes, 1, most));
}

}  // namespace

TiledFrames::TiledFrames(const File& file, const char* name, hid_t type, hsize_t rows, hsize_t cols,
                         const void* fill, Tiling tiling, std::uint64_t frames)
    : path_(file.path),
      failure_(fmt::format("{} cannot be written", name)),
      write_status_(file.write_status),
      value_bytes_(H5Tget_size(type)),
      rows_(rows),
      cols_(cols),
      chunk_frames_(frames_of(rows * cols * value_bytes_, tiling, frames)),
      tile_rows_(tile_of(rows, tiling == Tiling::strips ? kStripRows : kTile)),
      tile_cols_(tiling == Tiling::strips ? cols : tile_of(cols, kTile)) {
  const hsize_t tile_values = tile_rows_ * tile_cols_;
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
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
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

/// Makes a tile stored from the current frame on. Only what no later frame overwrites is filled.
void TiledFrames::start(Tile& tile) const {
  const bool is_cut = tile.rows < tile_rows_ || tile.cols < tile_cols_;
  const hsize_t frames_before = frames_ % chunk_frames_;
  if (tile.values.empty() || is_cut) {
    tile.values = fill_;
  } else {
    std::memcpy(tile.values.data(), fill_.data(),
                frames_before * tile_rows_ * tile_cols_ * value_bytes_);
  }
  tile.stored = true;
}

void TiledFrames::put(const std::byte* frame, Tile& tile) {
  if (!tile.stored && is_filled(frame, tile)) return;
  if (is_in_place(tile)) return write(tile, frames_, frame + tile.row * cols_ * value_bytes_);
  if (!tile.stored) start(tile);
  for (hsize_t row = 0; row < tile.rows; ++row) {
    std::memcpy(row_in(tile, row), frame + ((tile.row + row) * cols_ + tile.col) * value_bytes_,
                tile.cols * value_bytes_);
  }
}

/// True if the values of a tile lie in a frame as in the file.
bool TiledFrames::is_in_place(const Tile& tile) const {
  return chunk_frames_ == 1 && tile.cols == cols_ && tile.rows == tile_rows_;
}

void TiledFrames::extend(std::uint64_t frames) {
  const hsize_t extent[] = {frames, rows_, cols_};
  require(H5Dset_extent(dataset_.get(), extent), path_, failure_);
}

/// Writes the chunk of a tile that begins at the frame `first`.
void TiledFrames::write(const Tile& tile, std::uint64_t first, const std::byte* values) {
  const hsize_t start[] = {first, tile.row, tile.col};
  require(H5Dwrite_chunk(dataset_.get(), H5P_DEFAULT, 0, start, fill_.size(), values), path_,
          failure_);
}

void TiledFrames::append(const void* frame) {
  if (chunk_frames_ == 1) extend(frames_ + 1);
  for (Tile& tile : tiles_) put(static_cast<const std::byte*>(frame), tile);
  ++frames_;
  if (frames_ % chunk_frames_ == 0) flush();
}

void TiledFrames::flush() {
  if (flushed_ == frames_) return;
  extend(frames_);
  const std::uint64_t first = (frames_ - 1) / chunk_frames_ * chunk_frames_;
  const bool is_whole = frames_ % chunk_frames_ == 0;
  for (Tile& tile : tiles_) {
    if (!tile.stored) continue;
    write(tile, first, tile.values.data());
    if (is_whole) tile.stored = false;
  }
  flushed_ = frames_;
  require_written(*write_status_, path_);
}

}  // namespace pillarfield::hdf5
