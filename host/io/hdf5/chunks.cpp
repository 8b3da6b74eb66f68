#include "io/hdf5/chunks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <new>
#include <numeric>
#include <span>
#include <system_error>

#include "io/hdf5/crash_guard.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

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

/// Filters whose chunks have a known size, in the order in which they may be applied.
constexpr std::array kCheckedFilters = {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE,
                                        H5Z_FILTER_FLETCHER32};

/// Reads the filters of the chunks. Throws Error if HDF5 lacks one, or the file is untrusted and
/// has others than kCheckedFilters, or those in another order.
void read_filters(const File& file, const Handle& layout, const std::string& name,
                  Storage& storage) {
  const int count = H5Pget_nfilters(layout.get());
  require(count, file.path, fmt::format("the filters of {} cannot be read", name), kDamaged);
  const auto* next = kCheckedFilters.begin();
  for (unsigned index = 0; index < static_cast<unsigned>(count); ++index) {
    unsigned flags = 0;
    std::size_t values = 0;
    char filter_name[64] = "";
    const H5Z_filter_t filter = H5Pget_filter2(layout.get(), index, &flags, &values, nullptr,
                                               sizeof filter_name, filter_name, nullptr);
    if (H5Zfilter_avail(filter) <= 0) {
      throw Error(file.path.string(),
                  fmt::format("{} is stored with '{:.60}', HDF5 filter {}, which HDF5 lacks here",
                              name, filter_name, filter),
                  "store it with gzip, or uncompressed");
    }
    storage.filters.push_back(filter);
    next = std::find(next, kCheckedFilters.end(), filter);
    if (next != kCheckedFilters.end()) {
      ++next;
    } else if (file.trusted) {
      storage.is_checked = false;
    } else {
      throw Error(
          file.path.string(),
          fmt::format("{} is stored with '{:.60}', HDF5 filter {}, whose chunks are not checked",
                      name, filter_name, filter),
          "store it with gzip, alone or behind shuffle, or read a file of your own with "
          "--trust-input");
    }
  }
  storage.is_filtered = count > 0;
}

/// Size of deflated bytes when inflated, `most` + 1 if it is larger; 0 if they are damaged.
std::size_t inflated_bytes(std::span<std::byte> deflated, std::size_t most) {
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  std::array<Bytef, std::size_t{64} << 10U> part;
  stream.next_in = reinterpret_cast<Bytef*>(deflated.data());
  stream.avail_in = static_cast<uInt>(deflated.size());
  int result = Z_OK;
  while (result == Z_OK && stream.total_out <= most) {
    stream.next_out = part.data();
    stream.avail_out = static_cast<uInt>(part.size());
    result = inflate(&stream, Z_NO_FLUSH);
  }
  inflateEnd(&stream);
  if (stream.total_out > most) return most + 1;
  return result == Z_STREAM_END ? stream.total_out : 0;
}

/// Size of a stored chunk behind its filters but those that `skipped` names by their bits.
std::size_t unfiltered_bytes(const Storage& storage, std::span<std::byte> stored, unsigned skipped,
                             std::size_t most) {
  std::size_t bytes = stored.size();
  for (std::size_t index = storage.filters.size(); index-- > 0;) {
    if ((skipped >> index & 1U) != 0) continue;
    constexpr std::size_t kChecksumBytes = 4;
    if (storage.filters[index] == H5Z_FILTER_FLETCHER32) {
      bytes -= std::min(bytes, kChecksumBytes);
    } else if (storage.filters[index] == H5Z_FILTER_DEFLATE) {
      bytes = inflated_bytes(stored.first(bytes), most);
    }
  }
  return bytes;
}

/// Throws Error if the chunk that begins `at` these values is stored, and has another size than it
/// states: HDF5 reads memory of the process in place of bytes that lack.
void require_whole_chunk(const std::filesystem::path& path, const Handle& dataset,
                         const std::string& name, const Storage& storage,
                         const std::vector<hsize_t>& at) {
  const auto bytes = static_cast<std::size_t>(storage.chunk_bytes());
  const std::string failure = fmt::format("the chunk of {} at {} has another size than it states",
                                          name, fmt::join(at, ", "));
  hsize_t stored_bytes = 0;
  // Without any chunk, or where the index is damaged: then H5Dread() fails.
  if (H5Dget_chunk_storage_size(dataset.get(), at.data(), &stored_bytes) < 0) return;
  std::size_t found = stored_bytes;
  constexpr std::size_t kMostOverhead = 4096;
  const bool is_possible = stored_bytes <= 2 * bytes + kMostOverhead;
  if (stored_bytes == 0 || (storage.is_filtered && is_possible)) {
    std::vector<std::byte> stored(stored_bytes);
    std::uint32_t skipped = 0;
    std::byte none = {};
    const herr_t result = H5Dread_chunk(dataset.get(), H5P_DEFAULT, at.data(), &skipped,
                                        stored.empty() ? &none : stored.data());
    if (stored_bytes == 0 && result < 0) return;  // not stored
    require(result, path, failure, kDamaged);
    found = unfiltered_bytes(storage, stored, skipped, bytes);
  }
  if (found != bytes) throw Error(path.string(), failure, kDamaged);
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

double Storage::layer_bytes() const {
  double bytes = chunk_bytes();
  for (std::size_t d = 1; d < extent.size(); ++d) {
    bytes *= std::ceil(static_cast<double>(extent[d]) / static_cast<double>(chunk[d]));
  }
  return bytes;
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
  read_filters(file, layout, name, storage);
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

void require_whole_chunks(const std::filesystem::path& path, bool trusted, const Handle& dataset,
                          const std::string& name, const Storage& storage, std::uint64_t layer) {
  if (storage.chunk.empty() || !storage.is_checked) return;
  std::vector<hsize_t> at(storage.extent.size(), 0);
  at[0] = layer * storage.chunk[0];
  for (std::size_t d = 0; d != at.size();) {
    if (is_interrupted())
      throw Error(path.string(), "interrupted while it was read", "start again");
    const CrashGuard guard(path, trusted, storage.chunk_bytes());
    require_whole_chunk(path, dataset, name, storage, at);
    for (d = 1; d < at.size() && (at[d] += storage.chunk[d]) >= storage.extent[d]; ++d) at[d] = 0;
  }
}

}  // namespace pillarfield::hdf5
