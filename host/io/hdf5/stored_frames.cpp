#include "io/hdf5/stored_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "io/hdf5/file.h"
#include "io/hdf5/handle.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

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

void require_probe_limit(const File& file, const std::string& name, double values) {
  if (!file.probing || values <= static_cast<double>(kMaxProbedValues)) return;
  throw Error(file.path.string(),
              fmt::format("{} has {} values in a frame or plane, more than {}", name, values,
                          kMaxProbedValues),
              "read larger ones from a trusted file, with --trust-input");
}

StoredFrames::StoredFrames(const File& file, const std::string& name, std::size_t frame_rank,
                           bool may_lack_chunks)
    : path_(file.path), name_(name), dataset_(open_object(file, name.c_str())) {
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
  if (!storage_.filters.empty()) {
    chunks_ = std::make_unique<FilteredChunks>(path_, name_, storage_);
  }
  if (!file.probing) return;
  double values = 1;
  for (const hsize_t size : shape()) values *= static_cast<double>(size);
  require_probe_limit(file, name_, values);
  touch();
}

/// Reads everything in HDF5 that reading frames will need.
void StoredFrames::touch() const {
  if (!storage_.holds_values()) return;
  if (chunks_) return chunks_->touch(dataset_);
  double value = 0;
  std::vector<hsize_t> at(storage_.extent.size(), 0);
  const std::vector<hsize_t> one(at.size(), 1);
  read_selection(at, one, H5T_NATIVE_DOUBLE, &value);
  for (std::size_t d = 0; d < at.size(); ++d) at[d] = storage_.extent[d] - 1;
  read_selection(at, one, H5T_NATIVE_DOUBLE, &value);
}

void StoredFrames::get_all(std::uint64_t first, std::uint64_t count, hid_t memory_type,
                           void* frames) const {
  if (count == 0) return;
  std::vector<hsize_t> start(storage_.extent.size(), 0);
  std::vector<hsize_t> size = storage_.extent;
  start[0] = first;
  size[0] = count;
  if (!chunks_) return read_selection(start, size, memory_type, frames);
  if (H5Tequal(type_.get(), memory_type) > 0) {
    return chunks_->copy(dataset_, first, count, static_cast<std::byte*>(frames));
  }
  std::size_t values = 1;
  for (const hsize_t each : size) values *= each;
  const std::size_t bytes = values * H5Tget_size(memory_type);
  std::vector<std::byte> converted(std::max(bytes, values * storage_.value_bytes));
  chunks_->copy(dataset_, first, count, converted.data());
  require(H5Tconvert(type_.get(), memory_type, values, converted.data(), nullptr, H5P_DEFAULT),
          path_, fmt::format("{} cannot be converted", name_), kDamaged);
  std::memcpy(frames, converted.data(), bytes);
}

void StoredFrames::read_selection(const std::vector<hsize_t>& start,
                                  const std::vector<hsize_t>& count, hid_t memory_type,
                                  void* values) const {
  const std::string failure = start[0] == 0 && count[0] == storage_.extent[0]
                                  ? fmt::format("{} cannot be read", name_)
                                  : fmt::format("frame {} of {} cannot be read", start[0], name_);
  const int rank = static_cast<int>(start.size());
  const Handle source =
      own(H5Screate_simple(rank, storage_.extent.data(), nullptr), path_, failure);
  require(H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                              nullptr),
          path_, failure);
  const Handle target = own(H5Screate_simple(rank, count.data(), nullptr), path_, failure);
  require(H5Dread(dataset_.get(), memory_type, target.get(), source.get(), H5P_DEFAULT, values),
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
  require_probe_limit(file, name, static_cast<double>(rows) * static_cast<double>(cols));
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
