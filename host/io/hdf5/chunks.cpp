#include "io/hdf5/chunks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <system_error>

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

void require_filters(const File& file, const Handle& layout, const std::string& name) {
  const int count = H5Pget_nfilters(layout.get());
  require(count, file.path, fmt::format("the filters of {} cannot be read", name), kDamaged);
  for (unsigned index = 0; index < static_cast<unsigned>(count); ++index) {
    unsigned flags = 0;
    std::size_t values = 0;
    char filter_name[64] = "";
    const H5Z_filter_t filter = H5Pget_filter2(layout.get(), index, &flags, &values, nullptr,
                                               sizeof filter_name, filter_name, nullptr);
    if (H5Zfilter_avail(filter) > 0) continue;
    throw Error(file.path.string(),
                fmt::format("{} is stored with '{:.60}', HDF5 filter {}, which HDF5 lacks here",
                            name, filter_name, filter),
                "store it with gzip, or uncompressed");
  }
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
  return storage.is_filtered ? std::max(bytes / 1032, chunks_of(storage)) : bytes;
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
  return address + (storage.is_filtered ? bytes : (last_in_chunk + 1) * storage.value_bytes);
}

std::uint64_t bytes_of(const File& file) {
  std::error_code failed;
  const auto bytes = std::filesystem::file_size(file.path, failed);
  if (!failed) return bytes;
  throw Error(file.path.string(), failed.message(), "do not move it while it is read");
}

}  // namespace

bool Storage::holds_values() const { return std::ranges::find(extent, 0U) == extent.end(); }

std::size_t Storage::layer_bytes() const {
  double bytes = chunk_bytes();
  for (std::size_t d = 1; d < extent.size(); ++d) {
    bytes *= std::ceil(static_cast<double>(extent[d]) / static_cast<double>(chunk[d]));
  }
  return static_cast<std::size_t>(std::min(bytes, static_cast<double>(kMaxChunkBytes)));
}

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
  storage.is_filtered = H5Pget_nfilters(layout.get()) != 0;
  require_filters(file, layout, name);
  if (storage.is_filtered && storage.chunk_bytes() > static_cast<double>(kMaxChunkBytes)) {
    throw Error(file.path.string(),
                fmt::format("{} is compressed in chunks of {} values, more than {} MiB each", name,
                            fmt::join(storage.chunk, " x "), kMaxChunkBytes >> 20),
                "store it in smaller chunks");
  }
  H5D_fill_time_t fill_time = H5D_FILL_TIME_NEVER;
  H5Pget_fill_time(layout.get(), &fill_time);
  storage.is_filled =
      !storage.chunk.empty() && !storage.is_filtered && fill_time != H5D_FILL_TIME_NEVER;
  return storage;
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

}  // namespace pillarfield::hdf5
