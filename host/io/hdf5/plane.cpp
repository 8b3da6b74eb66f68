#include "io/hdf5/plane.h"

#include <fmt/format.h>

#include <string>

#include "io/hdf5/stored_frames.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {

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
