#include "io/hdf5_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <system_error>

#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

/// How the values of a dataset lie in its file.
struct Storage {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;  // empty: not in chunks
  bool filtered = false;       // compressed, or otherwise of another size than its values
  std::size_t value_bytes = 0;

  [[nodiscard]] bool holds_values() const {
    return std::find(extent.begin(), extent.end(), hsize_t{0}) == extent.end();
  }
};

double product(const std::vector<hsize_t>& sizes, std::size_t first) {
  return std::accumulate(
      sizes.begin() + static_cast<std::ptrdiff_t>(first), sizes.end(), 1.0,
      [](double bytes, hsize_t size) { return bytes * static_cast<double>(size); });
}

Handle creation_list(const File& file, const Handle& dataset, const char* name) {
  return own(H5Dget_create_plist(dataset.get()), file.path,
             fmt::format("the layout of {} cannot be read", name), kDamaged);
}

std::vector<hsize_t> chunk_of(const Handle& layout, std::size_t rank) {
  if (H5Pget_layout(layout.get()) != H5D_CHUNKED) return {};
  std::vector<hsize_t> chunk(rank);
  H5Pget_chunk(layout.get(), static_cast<int>(rank), chunk.data());
  return chunk;
}

void require_filters(const File& file, const Handle& layout, const char* name) {
  for (int index = 0; index < H5Pget_nfilters(layout.get()); ++index) {
    unsigned flags = 0;
    std::size_t values = 0;
    char filter_name[64] = "";
    const H5Z_filter_t filter =
        H5Pget_filter2(layout.get(), static_cast<unsigned>(index), &flags, &values, nullptr,
                       sizeof filter_name, filter_name, nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) > 0) continue;
    throw Error(file.path.string(),
                fmt::format("{} is compressed by '{:.60}', filter {}, which this HDF5 lacks", name,
                            filter_name, filter),
                "store it with gzip or uncompressed");
  }
}

Storage storage_of(const File& file, const Handle& dataset, const char* name) {
  const Handle layout = creation_list(file, dataset, name);
  if (H5Pget_layout(layout.get()) == H5D_VIRTUAL || H5Pget_external_count(layout.get()) > 0) {
    throw Error(file.path.string(), fmt::format("{} lies in another file", name),
                "copy its values into this one");
  }
  require_filters(file, layout, name);
  const Handle type = own(H5Dget_type(dataset.get()), file.path, "a dataset has no type");
  Storage storage;
  storage.extent = extent_of(file, dataset, name);
  storage.chunk = chunk_of(layout, storage.extent.size());
  storage.filtered = H5Pget_nfilters(layout.get()) > 0;
  storage.value_bytes = H5Tget_size(type.get());
  return storage;
}

/// Bytes that the file must have at least. Deflate shrinks by at most 1032.
double least_bytes(const Storage& storage) {
  const double frame_bytes = product(storage.extent, 1) * static_cast<double>(storage.value_bytes);
  if (storage.filtered) return frame_bytes / 1032;
  return frame_bytes * static_cast<double>(storage.extent[0]);
}

/// Where the last value of a dataset in chunks ends in its file.
std::uint64_t end_of_last_value(const File& file, const Handle& dataset, const char* name,
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
  return address + (storage.filtered ? bytes : (last_in_chunk + 1) * storage.value_bytes);
}

}  // namespace

Handle open_dataset(const File& file, const char* name) {
  const std::string failure = fmt::format("{} cannot be opened", name);
  if (!exists(file, name)) {
    throw Error(file.path.string(), fmt::format("has no {}", name),
                "docs/formats.md tells what the file must hold");
  }
  Handle dataset = own(H5Dopen2(file.id.get(), name, H5P_DEFAULT), file.path, failure, kDamaged);
  const Handle layout = creation_list(file, dataset, name);
  if (H5Pget_nfilters(layout.get()) <= 0) return dataset;
  const Handle type = own(H5Dget_type(dataset.get()), file.path, failure);
  const double chunk_bytes = product(chunk_of(layout, extent_of(file, dataset, name).size()), 0) *
                             static_cast<double>(H5Tget_size(type.get()));
  const Handle access = own(H5Pcreate(H5P_DATASET_ACCESS), file.path, failure);
  const auto cache_bytes = static_cast<std::size_t>(std::clamp(chunk_bytes, 1e6, 256e6));
  require(H5Pset_chunk_cache(access.get(), 521, cache_bytes, 1), file.path, failure);
  (void)dataset.close();
  return own(H5Dopen2(file.id.get(), name, access.get()), file.path, failure);
}

std::vector<hsize_t> extent_of(const File& file, const Handle& dataset, const char* name) {
  const std::string failure = fmt::format("{} is no array of numbers", name);
  const Handle space = own(H5Dget_space(dataset.get()), file.path, failure);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1) throw Error(file.path.string(), failure, "docs/formats.md tells its shape");
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  require(H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr), file.path, failure);
  return extent;
}

void require_within_file(const File& file, const Handle& dataset, const char* name) {
  const Storage storage = storage_of(file, dataset, name);
  if (!storage.holds_values()) return;
  std::error_code failed;
  const auto file_bytes = std::filesystem::file_size(file.path, failed);
  if (failed) {
    throw Error(file.path.string(), failed.message(), "leave it in its place while it is read");
  }
  if (least_bytes(storage) > static_cast<double>(file_bytes)) {
    throw Error(file.path.string(),
                fmt::format("{} claims to be {} values, more than the file's {} bytes can hold",
                            name, fmt::join(storage.extent, " x "), file_bytes),
                kDamaged);
  }
  // HDF5 compares the lengths itself where the writer closed the file.
  if (!file.unclosed || storage.chunk.empty()) return;
  if (end_of_last_value(file, dataset, name, storage) > file_bytes) {
    throw Error(file.path.string(), fmt::format("ends before the last frame of {}", name),
                kDamaged);
  }
}

std::vector<float> read_plane(const File& file, const char* name, std::size_t rows,
                              std::size_t cols) {
  const Handle dataset = open_dataset(file, name);
  const auto extent = extent_of(file, dataset, name);
  if (extent != std::vector<hsize_t>{rows, cols}) {
    throw Error(file.path.string(), fmt::format("{} is {} values", name, fmt::join(extent, " x ")),
                fmt::format("it needs one for each sensel, {} x {}", rows, cols));
  }
  require_within_file(file, dataset, name);
  std::vector<float> values(rows * cols);
  require(H5Dread(dataset.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          file.path, fmt::format("{} cannot be read as numbers", name), kDamaged);
  return values;
}

void write_plane(const File& file, const char* name, hid_t stored_type, hid_t memory_type,
                 std::size_t rows, std::size_t cols, const void* values) {
  const std::string failure = fmt::format("{} cannot be written", name);
  const std::vector<hsize_t> extent = {rows, cols};
  const Handle space = own(H5Screate_simple(2, extent.data(), nullptr), file.path, failure);
  const Handle dataset = own(H5Dcreate2(file.id.get(), name, stored_type, space.get(), H5P_DEFAULT,
                                        H5P_DEFAULT, H5P_DEFAULT),
                             file.path, failure);
  require(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), file.path,
          failure, "check the space left on its disk");
}

}  // namespace pillarfield::hdf5
