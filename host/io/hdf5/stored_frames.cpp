#include "io/hdf5/stored_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "io/hdf5/crash_guard.h"
#include "io/hdf5/file.h"
#include "io/hdf5/handle.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

/// HDF5's default.
constexpr std::size_t kLeastCacheBytes = std::size_t{1} << 20;

/// The number type of a dataset; NumPy stores booleans as an enumeration of int8.
Handle number_type(const std::filesystem::path& path, const std::string& name,
                   const Handle& dataset, bool& is_enumeration) {
  const std::string failure = fmt::format("{} has no type", name);
  Handle type = own(H5Dget_type(dataset.get()), path, failure, kDamaged);
  is_enumeration = H5Tget_class(type.get()) == H5T_ENUM;
  if (is_enumeration) {
    type = own(H5Tget_super(type.get()), path, failure, kDamaged);
  }
  require_number(path, name, type.get());
  return type;
}

}  // namespace

void require_frame_limit(const File& file, const std::string& name, double values) {
  if (file.trusted || values <= static_cast<double>(kMostUntrustedValues)) return;
  throw Error(file.path.string(),
              fmt::format("{} has {} values in a frame or plane, more than {}", name, values,
                          kMostUntrustedValues),
              "read larger ones from a trusted file, with --trust-input");
}

StoredFrames::StoredFrames(const File& file, const std::string& name, std::size_t frame_rank,
                           bool may_lack_chunks)
    : path_(file.path), name_(name), is_trusted_(file.trusted) {
  const CrashGuard guard(path_, is_trusted_);
  dataset_ = open_object(file, name.c_str());
  if (H5Iget_type(dataset_.get()) != H5I_DATASET) {
    throw Error(path_.string(), fmt::format("{} is not a dataset", name),
                "docs/formats.md lists the required objects");
  }
  type_ = number_type(path_, name_, dataset_, is_enumeration_);
  storage_ = storage_of(file, dataset_, name_);
  if (storage_.extent.size() != frame_rank + 1) {
    throw Error(path_.string(), fmt::format("{} has {} dimensions", name, storage_.extent.size()),
                fmt::format("it needs {}; see docs/formats.md", frame_rank + 1));
  }
  require_stored(file, dataset_, name_, storage_, may_lack_chunks);
  double values = 1;
  for (const hsize_t size : shape()) values *= static_cast<double>(size);
  require_frame_limit(file, name_, values);
  if (storage_.is_filtered) keep_inflated_chunks(file);
}

/// Opens the dataset again with a cache for the chunks that a frame lies in, so that chunks of many
/// frames are not inflated for each of them.
void StoredFrames::keep_inflated_chunks(const File& file) {
  const std::string failure = fmt::format("{} cannot be opened", name_);
  const Handle access = own(H5Pcreate(H5P_DATASET_ACCESS), path_, failure);
  require(H5Pset_chunk_cache(access.get(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT,
                             std::clamp(static_cast<std::size_t>(storage_.layer_bytes()),
                                        kLeastCacheBytes, kMaxChunkBytes),
                             H5D_CHUNK_CACHE_W0_DEFAULT),
          path_, failure);
  dataset_ = {};
  dataset_ = own(H5Dopen2(file.id.get(), name_.c_str(), access.get()), path_, failure, kDamaged);
}

void StoredFrames::get_all(std::uint64_t first, std::uint64_t count, hid_t memory_type,
                           void* frames) const {
  if (count == 0) return;
  std::vector<hsize_t> start(storage_.extent.size(), 0);
  std::vector<hsize_t> size = storage_.extent;
  start[0] = first;
  size[0] = count;
  double bytes = 0;  // of the chunks
  const std::uint64_t layer_frames = storage_.chunk.empty() ? 0 : storage_.chunk[0];
  for (std::uint64_t frame = first; layer_frames > 0 && frame < first + count;
       frame += layer_frames - frame % layer_frames) {
    const std::uint64_t layer = frame / layer_frames;
    if (whole_layers_.insert(layer).second) {
      require_whole_chunks(path_, is_trusted_, dataset_, name_, storage_, layer);
    }
    bytes += storage_.layer_bytes();
  }
  const CrashGuard guard(path_, is_trusted_, bytes);
  const std::string failure = first == 0 && count == storage_.extent[0]
                                  ? fmt::format("{} cannot be read", name_)
                                  : fmt::format("frame {} of {} cannot be read", first, name_);
  const int rank = static_cast<int>(start.size());
  const Handle source =
      own(H5Screate_simple(rank, storage_.extent.data(), nullptr), path_, failure);
  require(H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, size.data(),
                              nullptr),
          path_, failure);
  const Handle target = own(H5Screate_simple(rank, size.data(), nullptr), path_, failure);
  require(H5Dread(dataset_.get(), memory_type, target.get(), source.get(), H5P_DEFAULT, frames),
          path_, failure, kDamaged);
}

std::vector<float> read_plane(const File& file, const char* name, std::size_t rows,
                              std::size_t cols) {
  const StoredFrames stored(file, name, 1);
  if (stored.frames() != rows || stored.shape()[0] != cols) {
    throw Error(file.path.string(),
                fmt::format("{} is {} x {} values", name, stored.frames(), stored.shape()[0]),
                fmt::format("it needs one per sensel, {} x {}", rows, cols));
  }
  require_frame_limit(file, name, static_cast<double>(rows) * static_cast<double>(cols));
  std::vector<float> values(rows * cols);
  stored.get_all(0, rows, H5T_NATIVE_FLOAT, values.data());
  return values;
}

void write_plane(const File& file, const char* name, hid_t stored_type, hid_t memory_type,
                 std::size_t rows, std::size_t cols, const void* values) {
  const std::string failure = fmt::format("{} cannot be written", name);
  const std::vector<hsize_t> extent = {rows, cols};
  const Handle space = own(H5Screate_simple(2, extent.data(), nullptr), file.path, failure);
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
  const Handle dataset = own(H5Dcreate2(file.id.get(), name, stored_type, space.get(), H5P_DEFAULT,
                                        layout.get(), H5P_DEFAULT),
                             file.path, failure);
  require(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), file.path,
          failure, "check the space left on its disk");
}

void rewrite_plane(const File& file, const char* name, hid_t memory_type, const void* values) {
  const std::string failure = fmt::format("{} cannot be written", name);
  const Handle dataset = own(H5Dopen2(file.id.get(), name, H5P_DEFAULT), file.path, failure);
  require(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), file.path,
          failure, "check the space left on its disk");
}

}  // namespace pillarfield::hdf5
