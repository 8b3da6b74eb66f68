#include "io/hdf5/attribute.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/hdf5/crash_guard.h"
#include "io/hdf5/handle.h"
#include "pillarfield/error.h"

namespace pillarfield::hdf5 {
namespace {

constexpr std::size_t kLongestText = 1 << 16;
constexpr hssize_t kMostNumbers = 1 << 16;

void write_values(const File& file, hid_t object, const char* name, const Handle& space,
                  hid_t stored_type, hid_t memory_type, const void* values) {
  const std::string failure = fmt::format("cannot write attribute '{}'", name);
  const Handle attribute =
      own(H5Acreate2(object, name, stored_type, space.get(), H5P_DEFAULT, H5P_DEFAULT), file.path,
          failure);
  require(H5Awrite(attribute.get(), memory_type, values), file.path, failure);
}

void write_scalar(const File& file, hid_t object, const char* name, hid_t stored_type,
                  hid_t memory_type, const void* value) {
  const Handle space = own(H5Screate(H5S_SCALAR), file.path, "cannot make a data space");
  write_values(file, object, name, space, stored_type, memory_type, value);
}

Handle text_type(const File& file, std::size_t size) {
  Handle type = own(H5Tcopy(H5T_C_S1), file.path, "cannot make a string type");
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  H5Tset_size(type.get(), size);
  return type;
}

/// An open attribute, its type, and the message for failures.
struct Attribute {
  Handle id;
  Handle type;
  std::string failure;
  hssize_t values = 0;
};

std::optional<Attribute> open(const File& file, hid_t object, const char* name) {
  Attribute attribute;
  attribute.failure = fmt::format("attribute '{}' cannot be read", name);
  const htri_t found = H5Aexists(object, name);
  require(found, file.path, attribute.failure, kDamaged);
  if (found == 0) return std::nullopt;
  attribute.id = own(H5Aopen(object, name, H5P_DEFAULT), file.path, attribute.failure);
  attribute.type = own(H5Aget_type(attribute.id.get()), file.path, attribute.failure);
  const Handle space = own(H5Aget_space(attribute.id.get()), file.path, attribute.failure);
  attribute.values = H5Sget_simple_extent_npoints(space.get());
  return attribute;
}

std::optional<Attribute> open_single(const File& file, hid_t object, const char* name) {
  auto attribute = open(file, object, name);
  if (attribute && attribute->values != 1) {
    throw Error(file.path.string(), fmt::format("attribute '{}' is not a single value", name),
                "store one value");
  }
  return attribute;
}

std::string read_variable_text(const File& file, const Attribute& attribute) {
  // HDF5 does not convert character sets, so the memory type has the stored one.
  const Handle type = text_type(file, H5T_VARIABLE);
  H5Tset_cset(type.get(), H5Tget_cset(attribute.type.get()));
  char* text = nullptr;
  require(H5Aread(attribute.id.get(), type.get(), static_cast<void*>(&text)), file.path,
          attribute.failure);
  std::string copy = text == nullptr ? "" : text;
  H5free_memory(text);
  return copy;
}

std::string read_fixed_text(const File& file, const Attribute& attribute) {
  const std::size_t size = H5Tget_size(attribute.type.get());
  if (size > kLongestText) throw Error(file.path.string(), attribute.failure, "it is too long");
  std::string text(size, '\0');
  require(H5Aread(attribute.id.get(), attribute.type.get(), text.data()), file.path,
          attribute.failure);
  text.resize(std::min(text.find('\0'), text.size()));
  if (H5Tget_strpad(attribute.type.get()) == H5T_STR_SPACEPAD) {
    text.resize(text.find_last_not_of(' ') + 1);
  }
  return text;
}

}  // namespace

void Attributes::write(const char* name, int value) const {
  write_scalar(file_, object_, name, H5T_STD_I64LE, H5T_NATIVE_INT, &value);
}

void Attributes::write(const char* name, double value) const {
  write_scalar(file_, object_, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void Attributes::write(const char* name, const std::string& value) const {
  const Handle type = text_type(file_, value.size() + 1);
  write_scalar(file_, object_, name, type.get(), type.get(), value.c_str());
}

void Attributes::write(const char* name, const std::vector<double>& values) const {
  const hsize_t extent = values.size();
  const Handle space =
      own(H5Screate_simple(1, &extent, nullptr), file_.path, "cannot make a data space");
  write_values(file_, object_, name, space, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data());
}

void Attributes::write(const char* name, const Pitch& pitch) const {
  if (pitch.is_square()) return write(name, pitch.col_mm);
  write(name, std::vector{pitch.row_mm, pitch.col_mm});
}

void Attributes::rewrite(const char* name, double value) const {
  const auto attribute = open(file_, object_, name);
  if (!attribute) throw Error(file_.path.string(), fmt::format("has no attribute '{}'", name), "");
  require(H5Awrite(attribute->id.get(), H5T_NATIVE_DOUBLE, &value), file_.path, attribute->failure);
}

std::optional<double> Attributes::number(const char* name) const {
  const CrashGuard guard(file_.path, file_.trusted);
  const auto attribute = open_single(file_, object_, name);
  if (!attribute) return std::nullopt;
  require_number(file_.path, fmt::format("attribute '{}'", name), attribute->type.get());
  double value = 0;
  require(H5Aread(attribute->id.get(), H5T_NATIVE_DOUBLE, &value), file_.path, attribute->failure);
  return value;
}

std::optional<std::vector<double>> Attributes::numbers(const char* name) const {
  const CrashGuard guard(file_.path, file_.trusted);
  const auto attribute = open(file_, object_, name);
  if (!attribute) return std::nullopt;
  require_number(file_.path, fmt::format("attribute '{}'", name), attribute->type.get());
  if (attribute->values < 1 || attribute->values > kMostNumbers) {
    throw Error(file_.path.string(),
                fmt::format("attribute '{}' has {} values", name, attribute->values),
                fmt::format("store 1 to {}", kMostNumbers));
  }
  std::vector<double> values(static_cast<std::size_t>(attribute->values));
  require(H5Aread(attribute->id.get(), H5T_NATIVE_DOUBLE, values.data()), file_.path,
          attribute->failure);
  return values;
}

std::optional<Pitch> Attributes::pitch(const char* name) const {
  const auto numbers = this->numbers(name);
  if (!numbers) return std::nullopt;
  if (numbers->size() == 1) return Pitch(numbers->front());
  if (numbers->size() == 2) return Pitch(numbers->front(), numbers->back());
  throw Error(file_.path.string(), fmt::format("{} has {} numbers", name, numbers->size()),
              "store one, or two: from row to row and from column to column, mm");
}

std::optional<std::string> Attributes::text(const char* name) const {
  const CrashGuard guard(file_.path, file_.trusted);
  const auto attribute = open_single(file_, object_, name);
  if (!attribute) return std::nullopt;
  if (H5Tget_class(attribute->type.get()) != H5T_STRING) {
    throw Error(file_.path.string(),
                fmt::format("attribute '{}' must be a string, not {}", name,
                            name_of_type(attribute->type.get())),
                "store a string");
  }
  const bool variable = H5Tis_variable_str(attribute->type.get()) > 0;
  return variable ? read_variable_text(file_, *attribute) : read_fixed_text(file_, *attribute);
}

}  // namespace pillarfield::hdf5
