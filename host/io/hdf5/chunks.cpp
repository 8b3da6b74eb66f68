#include "io/hdf5/chunks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <system_error>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

double product(const std::vector<hsize_t>& sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), 1.0, [](double values, hsize_t size) {
    return values * static_cast<double>(size);
  });
}

std::vector<hsize_t> extent_of(const File& file, const Handle& dataset, const std::string& name) {
  const std::string failure = fmt::format("{} is not an array of numbers", name);
  const Handle space = own(H5Dget_space(dataset.get()), file.path, failure, kDamaged);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1) throw Error(file.path.string(), failure, "docs/formats.md gives its shape");
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  require(H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr), file.path, failure);
  return extent;
}

std::vector<hsize_t> chunk_of(const File& file, const Handle& layout, const std::string& name,
                              std::size_t rank) {
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return {};
  std::vector<hsize_t> chunk(rank);
  const int found = H5Pget_chunk(layout.get(), static_cast<int>(rank), chunk.data());
  const bool fits = found == static_cast<int>(rank) && std::ranges::find(chunk, 0U) == chunk.end();
  if (fits) return chunk;
  throw Error(file.path.string(), fmt::format("the chunks of {} have no size", name), kDamaged);
}

/// Number of chunks that the values fill.
double chunks_of(const Storage& storage) {
  double chunks = 1;
  for (std::size_t d = 0; d < storage.extent.size(); ++d) {
    const hsize_t along = (storage.extent[d] - 1) / storage.chunk[d] + 1;
    chunks *= static_cast<double>(along);
  }
  return chunks;
}

/// Least size of the file, bytes. Deflate compresses by a factor of at most 1032.
double least_bytes(const Storage& storage) {
  const double bytes = product(storage.extent) * static_cast<double>(storage.value_bytes);
  return storage.filters.empty() ? bytes : std::max(bytes / 1032, chunks_of(storage));
}

/// Number of stored chunks; HDF5 walks the whole chunk index.
double stored_chunks(const File& file, const Handle& dataset, const std::string& name) {
  const std::string failure = fmt::format("the chunks of {} cannot be counted", name);
  const Handle space = own(H5Dget_space(dataset.get()), file.path, failure, kDamaged);
  hsize_t chunks = 0;
  require(H5Dget_num_chunks(dataset.get(), space.get(), &chunks), file.path, failure, kDamaged);
  return static_cast<double>(chunks);
}

/// File offset of the end of the last value of a chunked dataset.
std::uint64_t end_of_last_value(const File& file, const Handle& dataset, const std::string& name,
                                const Storage& storage) {
  std::vector<hsize_t> chunk_start(storage.extent.size());
  std::uint64_t last_in_chunk = 0;
  for (std::size_t d = 0; d < chunk_start.size(); ++d) {
    const hsize_t within = (storage.extent[d] - 1) % storage.chunk[d];
    chunk_start[d] = storage.extent[d] - 1 - within;
    last_in_chunk = last_in_chunk * storage.chunk[d] + within;
  }
  unsigned skipped_filters = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  require(H5Dget_chunk_info_by_coord(dataset.get(), chunk_start.data(), &skipped_filters, &address,
                                     &bytes),
          file.path, fmt::format("{} cannot be read", name), kDamaged);
  if (address == HADDR_UNDEF) return 0;
  const bool filtered = !storage.filters.empty();
  return address + (filtered ? bytes : (last_in_chunk + 1) * storage.value_bytes);
}

std::uint64_t bytes_of(const File& file) {
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(file.path, failed);
  if (!failed) return bytes;
  throw Error(file.path.string(), failed.message(), "do not move it while it is read");
}

}  // namespace

bool Storage::holds_values() const { return std::ranges::find(extent, 0U) == extent.end(); }

double Storage::chunk_bytes() const { return product(chunk) * static_cast<double>(value_bytes); }

Storage storage_of(const File& file, const Handle& dataset, const std::string& name) {
  const Handle layout = own(H5Dget_create_plist(dataset.get()), file.path,
                            fmt::format("the layout of {} cannot be read", name), kDamaged);
  if (H5Pget_layout(layout.get()) == H5D_VIRTUAL || H5Pget_external_count(layout.get()) > 0) {
    throw Error(file.path.string(), fmt::format("{} lies in another file", name),
                "copy its values into this one");
  }
  const Handle type =
      own(H5Dget_type(dataset.get()), file.path, fmt::format("{} has no type", name), kDamaged);
  Storage storage;
  storage.value_bytes = H5Tget_size(type.get());
  storage.extent = extent_of(file, dataset, name);
  storage.chunk = chunk_of(file, layout, name, storage.extent.size());
  storage.filters = {file.path, name, layout, storage.value_bytes};
  H5D_fill_time_t fill_time = H5D_FILL_TIME_NEVER;
  H5Pget_fill_time(layout.get(), &fill_time);
  storage.is_filled =
      !storage.chunk.empty() && storage.filters.empty() && fill_time != H5D_FILL_TIME_NEVER;
  unsigned options = 0;
  if (!storage.filters.empty()) H5Pget_chunk_opts(layout.get(), &options);
  if (options == 0) return storage;
  throw Error(file.path.string(), fmt::format("the last chunks of {} are stored unfiltered", name),
              "store all chunks with the same filters");
}

void require_stored(const File& file, const Handle& dataset, const std::string& name,
                    const Storage& storage, bool may_lack_chunks) {
  if (!storage.holds_values() || (may_lack_chunks && storage.is_filled)) return;
  const std::uint64_t file_bytes = bytes_of(file);
  if (least_bytes(storage) > static_cast<double>(file_bytes)) {
    throw Error(file.path.string(),
                fmt::format("{} claims {} values, more than the file's {} bytes can hold", name,
                            fmt::join(storage.extent, " x "), file_bytes),
                kDamaged);
  }
  if (storage.chunk.empty()) return;
  const double stored = stored_chunks(file, dataset, name);
  if (file.unclosed) {
    // HDF5 itself checks the length of a closed file.
    if (end_of_last_value(file, dataset, name, storage) <= file_bytes) return;
    throw Error(file.path.string(), fmt::format("ends before the last frame of {}", name),
                kDamaged);
  }
  if (stored >= chunks_of(storage)) return;
  throw Error(file.path.string(),
              fmt::format("{} claims {} values in {} chunks, but only {} are stored", name,
                          fmt::join(storage.extent, " x "), chunks_of(storage), stored),
              "the file is damaged, or the dataset is longer than its data; shorten it");
}

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
