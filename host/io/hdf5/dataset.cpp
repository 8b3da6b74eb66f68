#include "io/hdf5/dataset.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "io/hdf5/crash_guard.h"
#include "io/hdf5/file.h"
#include "io/hdf5/handle.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

class Dataset final : public NumberArray {
 public:
  Dataset(std::shared_ptr<const File> file, std::string place, NumberType type,
          std::vector<std::uint64_t> shape, StoredFrames stored)
      : NumberArray(std::move(place), type, std::move(shape)),
        file_(std::move(file)),
        stored_(std::move(stored)) {}

  void read(std::uint64_t first, std::uint64_t count, std::byte* numbers) override {
    const QuietErrors quiet;
    stored_.get_all(first, count, memory_type_of(type()), numbers);
  }

 private:
  std::shared_ptr<const File> file_;  // closed after the dataset
  StoredFrames stored_;
};

/// "/raw" for "raw", without a slash at the end.
std::string absolute(std::string name) {
  while (name.size() > 1 && name.ends_with('/')) name.pop_back();
  return name.starts_with('/') ? name : "/" + name;
}

std::size_t dimensions_of(const Handle& dataset) {
  const Handle space(H5Dget_space(dataset.get()));
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  return rank > 0 ? static_cast<std::size_t>(rank) : 0;
}

}  // namespace

NumberType number_type_of(const StoredFrames& stored, const File& file) {
  using Kind = NumberType::Kind;
  if (stored.is_enumeration()) {
    throw Error(file.path.string(),
                fmt::format("{} holds booleans, which are not readings", stored.name()),
                "store integers, float32 or float64");
  }
  const std::size_t bytes = H5Tget_size(stored.type());
  if (stored.value_class() == H5T_FLOAT && bytes == 2) {
    throw Error(file.path.string(),
                fmt::format("{} is float16, which is not a type of readings", stored.name()),
                "store integers, float32 or float64");
  }
  if (stored.value_class() == H5T_FLOAT) return {Kind::real, bytes};
  const bool is_signed = H5Tget_sign(stored.type()) != H5T_SGN_NONE;
  return {is_signed ? Kind::signed_integer : Kind::unsigned_integer, bytes};
}

hid_t memory_type_of(NumberType type) {
  using Kind = NumberType::Kind;
  if (type.kind == Kind::real) return type.bytes == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  const bool is_signed = type.kind == Kind::signed_integer;
  switch (type.bytes) {
    case 1:
      return is_signed ? H5T_NATIVE_INT8 : H5T_NATIVE_UINT8;
    case 2:
      return is_signed ? H5T_NATIVE_INT16 : H5T_NATIVE_UINT16;
    case 4:
      return is_signed ? H5T_NATIVE_INT32 : H5T_NATIVE_UINT32;
    default:
      return is_signed ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64;
  }
}

std::unique_ptr<NumberArray> open_dataset(const std::shared_ptr<const File>& opened,
                                          const std::string& name) {
  const File& file = *opened;
  const std::string path = absolute(name);
  if (!exists(file, path)) {
    throw Error(file.path.string(), fmt::format("has no dataset {}", path),
                fmt::format("it has {}", fmt::join(list_datasets(file), ", ")));
  }
  const std::size_t dimensions = dimensions_of(open_object(file, path.c_str()));
  if (dimensions < 1 || dimensions > 5) {
    throw Error(file.path.string(), fmt::format("{} is not a dataset of 1 to 5 dimensions", path),
                "frames need the shape (frames, rows, columns)");
  }
  StoredFrames stored(file, path, dimensions - 1);
  std::vector<std::uint64_t> shape = {stored.frames()};
  for (const hsize_t size : stored.shape()) shape.push_back(size);
  const NumberType type = number_type_of(stored, file);
  return std::make_unique<Dataset>(opened, fmt::format("{}: {}", file.path.string(), path), type,
                                   std::move(shape), std::move(stored));
}

std::vector<std::string> list_datasets(const File& file) {
  const CrashGuard guard(file.path, file.trusted);
  std::vector<std::string> names;
  H5Lvisit(
      file.id.get(), H5_INDEX_NAME, H5_ITER_NATIVE,
      [](hid_t root, const char* name, const H5L_info_t* link, void* found) -> herr_t {
        constexpr std::size_t kMostNames = 10;
        auto& list = *static_cast<std::vector<std::string>*>(found);
        if (link->type != H5L_TYPE_HARD) return 0;
        const Handle object(H5Oopen(root, name, H5P_DEFAULT));
        if (!object.valid() || H5Iget_type(object.get()) != H5I_DATASET) return 0;
        const std::size_t dimensions = dimensions_of(object);
        if (dimensions == 2 || dimensions == 3) list.push_back("/" + std::string(name));
        return list.size() < kMostNames ? 0 : 1;
      },
      &names);
  return names;
}

}  // namespace pillarfield::hdf5
