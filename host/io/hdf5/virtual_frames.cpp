#include "io/hdf5/virtual_frames.h"

#include <fmt/format.h>

#include <string>

namespace pillarfield::hdf5 {
namespace {

/// HDF5 takes % in the name of a source for a format.
std::string escaped(const std::string& name) {
  std::string result;
  for (const char c : name) result.append(c == '%' ? 2 : 1, c);
  return result;
}

}  // namespace

void create_virtual_frames(const File& file, const char* name, hid_t stored_type,
                           const std::vector<hsize_t>& extent,
                           const std::vector<VirtualPart>& parts, const void* fill) {
  const std::string failure = fmt::format("{} cannot be written", name);
  const int rank = static_cast<int>(extent.size());
  const Handle space = own(H5Screate_simple(rank, extent.data(), nullptr), file.path, failure);
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
  require(H5Pset_fill_value(layout.get(), stored_type, fill), file.path, failure);
  for (const VirtualPart& part : parts) {
    std::vector<hsize_t> count = extent;
    count[0] = part.frames;
    std::vector<hsize_t> start(extent.size(), 0);
    start[0] = part.first;
    const Handle source = own(H5Screate_simple(rank, count.data(), nullptr), file.path, failure);
    require(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                nullptr),
            file.path, failure);
    require(
        H5Pset_virtual(layout.get(), space.get(), escaped(part.file).c_str(), name, source.get()),
        file.path, failure);
  }
  require(H5Sselect_all(space.get()), file.path, failure);
  const Handle dataset = own(H5Dcreate2(file.id.get(), name, stored_type, space.get(), H5P_DEFAULT,
                                        layout.get(), H5P_DEFAULT),
                             file.path, failure);
}

void write_numbers(const File& file, const char* name, const std::vector<double>& values) {
  const std::string failure = fmt::format("{} cannot be written", name);
  const hsize_t size = values.size();
  const Handle space = own(H5Screate_simple(1, &size, nullptr), file.path, failure);
  const Handle layout = creation_properties(file, H5P_DATASET_CREATE);
  const Handle dataset = own(H5Dcreate2(file.id.get(), name, H5T_IEEE_F64LE, space.get(),
                                        H5P_DEFAULT, layout.get(), H5P_DEFAULT),
                             file.path, failure);
  require(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          file.path, failure, "check the space left on its disk");
  require_written(*file.write_status, file.path);
}

}  // namespace pillarfield::hdf5
