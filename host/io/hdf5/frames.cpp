#include "io/hdf5/frames.h"

#include <fmt/format.h>

#include <algorithm>

namespace pillarfield::hdf5 {
namespace {

constexpr hsize_t kChunkBytes = 256 << 10;
constexpr hsize_t kMaxFramesOfChunk = 1024;
constexpr hsize_t kLargestChunkBytes = 1 << 30;  // HDF5 allows less than 4 GiB

std::vector<hsize_t> with_frames(hsize_t frames, const FrameShape& shape) {
  std::vector<hsize_t> extent = {frames};
  extent.insert(extent.end(), shape.begin(), shape.end());
  return extent;
}

/// Chunk shape: several small frames per chunk; a frame above the largest chunk is split by rows.
std::vector<hsize_t> chunk_of(const FrameShape& shape, hsize_t value_bytes) {
  hsize_t frame_bytes = value_bytes;
  for (const hsize_t size : shape) frame_bytes *= size;
  std::vector<hsize_t> chunk =
      with_frames(std::clamp<hsize_t>(kChunkBytes / frame_bytes, 1, kMaxFramesOfChunk), shape);
  if (frame_bytes > kLargestChunkBytes) {
    chunk[1] = std::max<hsize_t>(1, shape[0] * kLargestChunkBytes / frame_bytes);
  }
  return chunk;
}

/// Selects frames of a dataset's space.
Handle frame_selection(const std::filesystem::path& path, const std::string& failure,
                       const std::vector<hsize_t>& extent, std::uint64_t index,
                       std::uint64_t frames = 1) {
  Handle space =
      own(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), path, failure);
  std::vector<hsize_t> start(extent.size(), 0);
  std::vector<hsize_t> count = extent;
  start[0] = index;
  count[0] = frames;
  require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                              nullptr),
          path, failure);
  return space;
}

/// Memory space of one frame whose rows are `row_stride` values apart.
Handle memory_selection(const std::filesystem::path& path, const std::string& failure,
                        const std::vector<hsize_t>& extent, hsize_t row_stride) {
  std::vector<hsize_t> count = extent;
  count[0] = 1;
  std::vector<hsize_t> memory = count;
  memory.back() = std::max(memory.back(), row_stride);
  Handle space =
      own(H5Screate_simple(static_cast<int>(memory.size()), memory.data(), nullptr), path, failure);
  const std::vector<hsize_t> start(extent.size(), 0);
  require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                              nullptr),
          path, failure);
  return space;
}

/// Memory space of dense frames.
Handle dense_frames(const std::filesystem::path& path, const std::string& failure,
                    std::vector<hsize_t> extent, std::uint64_t frames) {
  extent[0] = frames;
  return own(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), path,
             failure);
}

}  // namespace

ExtendibleDataset::ExtendibleDataset(const File& file, const char* name, hid_t stored_type,
                                     const FrameShape& shape)
    : path_(file.path),
      failure_(fmt::format("{} cannot be written", name)),
      write_status_(file.write_status),
      extent_(with_frames(0, shape)) {
  const auto chunk = chunk_of(shape, H5Tget_size(stored_type));
  auto longest = extent_;
  longest[0] = H5S_UNLIMITED;
  const int rank = static_cast<int>(extent_.size());
  const Handle space = own(H5Screate_simple(rank, extent_.data(), longest.data()), path_, failure_);
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
  require(H5Pset_chunk(layout.get(), rank, chunk.data()), path_, failure_);
  // No chunk is filled with zeros before its frames are written.
  require(H5Pset_fill_time(layout.get(), H5D_FILL_TIME_NEVER), path_, failure_);
  const Handle access = own(H5Pcreate(H5P_DATASET_ACCESS), path_, failure_);
  require(H5Pset_chunk_cache(access.get(), 0, 0, 1), path_, failure_);
  dataset_ = own(H5Dcreate2(file.id.get(), name, stored_type, space.get(), H5P_DEFAULT,
                            layout.get(), access.get()),
                 path_, failure_);
}

void ExtendibleDataset::put(std::uint64_t index, hid_t memory_type, const void* frame,
                            std::size_t row_stride) {
  if (index >= extent_[0]) {
    auto longer = extent_;
    longer[0] = index + 1;
    require(H5Dset_extent(dataset_.get(), longer.data()), path_, failure_);
    extent_ = longer;
  }
  const Handle target = frame_selection(path_, failure_, extent_, index);
  const Handle source = memory_selection(path_, failure_, extent_, row_stride);
  require(H5Dwrite(dataset_.get(), memory_type, source.get(), target.get(), H5P_DEFAULT, frame),
          path_, failure_);
  require_written(*write_status_, path_);
}

void ExtendibleDataset::append(hid_t memory_type, const void* frames, std::size_t count) {
  if (count == 0) return;
  const hsize_t first = extent_[0];
  extent_[0] += count;
  require(H5Dset_extent(dataset_.get(), extent_.data()), path_, failure_);
  const Handle target = frame_selection(path_, failure_, extent_, first, count);
  const Handle source = dense_frames(path_, failure_, extent_, count);
  require(H5Dwrite(dataset_.get(), memory_type, source.get(), target.get(), H5P_DEFAULT, frames),
          path_, failure_);
  require_written(*write_status_, path_);
}

}  // namespace pillarfield::hdf5
