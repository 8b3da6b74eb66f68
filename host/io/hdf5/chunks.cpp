#include "io/hdf5/chunks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

constexpr std::size_t kInflatedBytes = std::size_t{32} << 20;

/// Largest deflated size: incompressible data grow by 5 bytes per 16 KiB, plus a header.
constexpr std::size_t longest_stored(std::size_t bytes) { return bytes + bytes / 1000 + 1024; }

}  // namespace

FilteredChunks::FilteredChunks(std::filesystem::path file, std::string name, const Storage& storage)
    : file_(std::move(file)),
      name_(std::move(name)),
      rank_(storage.extent.size()),
      filters_(storage.filters),
      value_bytes_(storage.value_bytes) {
  if (storage.chunk_bytes() > static_cast<double>(kMaxChunkBytes)) {
    throw Error(file_.string(),
                fmt::format("{} is compressed in chunks of {} values, more than {} MiB each", name_,
                            fmt::join(storage.chunk, " x "), kMaxChunkBytes >> 20),
                "store it in smaller chunks");
  }
  if (rank_ > extent_.size()) {
    throw Error(file_.string(), fmt::format("{} has {} dimensions", name_, rank_),
                "docs/formats.md gives its shape");
  }
  std::ranges::copy(storage.extent, extent_.begin());
  std::ranges::copy(storage.chunk, chunk_.begin());
  frame_bytes_ = extent_[1] * extent_[2] * value_bytes_;
  chunk_bytes_ = chunk_[0] * chunk_[1] * chunk_[2] * value_bytes_;
}

void FilteredChunks::copy(const Handle& dataset, std::uint64_t first, std::uint64_t count,
                          std::byte* frames) {
  while (count > 0) {
    if (first < first_ || first >= end_) inflate_frames(dataset, first);
    const std::uint64_t here = std::min(count, end_ - first);
    std::memcpy(frames, frames_.data() + (first - first_) * frame_bytes_, here * frame_bytes_);
    frames += here * frame_bytes_;
    first += here;
    count -= here;
  }
}

void FilteredChunks::touch(const Handle& dataset) const {
  Place last{};
  for (std::size_t d = 0; d < last.size(); ++d) last[d] = (extent_[d] - 1) / chunk_[d] * chunk_[d];
  std::uint32_t skipped = 0;
  (void)stored_chunk(dataset, {}, skipped);
  (void)stored_chunk(dataset, last, skipped);
}

/// Inflates all frames of the chunks that hold frame `wanted`, or those from `wanted` on that fit
/// into the cache.
void FilteredChunks::inflate_frames(const Handle& dataset, std::uint64_t wanted) {
  const hsize_t chunk_first = wanted / chunk_[0] * chunk_[0];
  const hsize_t chunk_end = chunk_first + std::min(chunk_[0], extent_[0] - chunk_first);
  const std::uint64_t most = std::max<std::uint64_t>(1, kInflatedBytes / frame_bytes_);
  end_ = 0;  // empty if this throws
  first_ = chunk_end - chunk_first <= most ? chunk_first : wanted;
  const std::uint64_t end = std::min<hsize_t>(chunk_end, first_ + most);
  frames_.resize((end - first_) * frame_bytes_);
  end_ = end;
  try {
    for (hsize_t row = 0; row < extent_[1]; row += chunk_[1]) {
      for (hsize_t col = 0; col < extent_[2]; col += chunk_[2]) {
        const Place start = {chunk_first, row, col};
        std::uint32_t skipped = 0;
        std::vector<std::byte> stored = stored_chunk(dataset, start, skipped);
        copy_chunk(filters_.undo(std::move(stored), skipped, chunk_bytes_), start);
      }
    }
  } catch (...) {
    end_ = 0;
    throw;
  }
}

/// Copies the part of a chunk that lies in the dataset and in the cached frames.
void FilteredChunks::copy_chunk(const std::vector<std::byte>& chunk, const Place& start) {
  const hsize_t end_frame = std::min<hsize_t>(end_, start[0] + chunk_[0]);
  const hsize_t rows = std::min(chunk_[1], extent_[1] - start[1]);
  const hsize_t cols = std::min(chunk_[2], extent_[2] - start[2]);
  for (hsize_t frame = std::max<hsize_t>(first_, start[0]); frame < end_frame; ++frame) {
    for (hsize_t row = 0; row < rows; ++row) {
      const hsize_t from = ((frame - start[0]) * chunk_[1] + row) * chunk_[2];
      const hsize_t to = ((frame - first_) * extent_[1] + start[1] + row) * extent_[2] + start[2];
      std::memcpy(frames_.data() + to * value_bytes_, chunk.data() + from * value_bytes_,
                  cols * value_bytes_);
    }
  }
}

std::vector<std::byte> FilteredChunks::stored_chunk(const Handle& dataset, const Place& start,
                                                    std::uint32_t& skipped) const {
  const std::string failure =
      fmt::format("the chunk of {} at frame {} cannot be read", name_, start[0]);
  hsize_t bytes = 0;
  require(H5Dget_chunk_storage_size(dataset.get(), start.data(), &bytes), file_, failure, kDamaged);
  if (bytes == 0) {
    throw Error(file_.string(), fmt::format("{} was never written at frame {}", name_, start[0]),
                kDamaged);
  }
  const std::size_t most = longest_stored(chunk_bytes_);
  if (bytes > most) {
    throw Error(file_.string(),
                fmt::format("a chunk of {} has {} bytes instead of {}", name_, bytes, chunk_bytes_),
                kDamaged);
  }
  // HDF5 reads the size again: a writer may have replaced the chunk by a longer one meanwhile.
  std::vector<std::byte> stored(most);
  require(H5Dread_chunk(dataset.get(), H5P_DEFAULT, start.data(), &skipped, stored.data()), file_,
          failure, kDamaged);
  stored.resize(bytes);
  return stored;
}

}  // namespace pillarfield::hdf5
