#include "io/hdf5/handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pillarfield/error.h"
#include "pillarfield/read_options.h"

namespace pillarfield::hdf5 {
namespace {

bool is_standard(hid_t type) {
  const std::array standard = {H5T_STD_U8LE,   H5T_STD_U8BE,   H5T_STD_I8LE,   H5T_STD_I8BE,
                               H5T_STD_U16LE,  H5T_STD_U16BE,  H5T_STD_I16LE,  H5T_STD_I16BE,
                               H5T_STD_U32LE,  H5T_STD_U32BE,  H5T_STD_I32LE,  H5T_STD_I32BE,
                               H5T_STD_U64LE,  H5T_STD_U64BE,  H5T_STD_I64LE,  H5T_STD_I64BE,
                               H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE, H5T_IEEE_F64BE};
  return std::ranges::any_of(standard, [&](hid_t each) { return H5Tequal(type, each) > 0; });
}

/// HDF5 1 has no predefined float of 2 bytes, but NumPy stores it.
bool is_half(hid_t type) {
  if (H5Tget_class(type) != H5T_FLOAT || H5Tget_size(type) != 2) return false;
  const Handle half(H5Tcopy(H5T_IEEE_F32LE));
  H5Tset_fields(half.get(), 15, 10, 5, 0, 10);
  H5Tset_size(half.get(), 2);
  H5Tset_ebias(half.get(), 15);
  H5Tset_order(half.get(), H5Tget_order(type));
  return H5Tequal(type, half.get()) > 0;
}

std::string name_of_number(const char* kind, hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  if (is_standard(type) || is_half(type)) return fmt::format("{}{}", kind, 8 * bytes);
  return fmt::format("{} of {} bytes in a non-standard layout", kind, bytes);
}

}  // namespace

std::string name_of_type(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return name_of_number(H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int", type);
    case H5T_FLOAT:
      return name_of_number("float", type);
    case H5T_STRING:
      return "a string";
    case H5T_COMPOUND:
      return "a compound";
    case H5T_ENUM:
      return "an enumeration";
    case H5T_ARRAY:
    case H5T_VLEN:
      return "an array";
    default:
      return "not a number";
  }
}

void require_number(const std::filesystem::path& file, std::string_view what, hid_t type) {
  if (is_standard(type) || is_half(type)) return;
  throw Error(file.string(), fmt::format("{} must be a number, not {}", what, name_of_type(type)),
              "store a standard integer or float");
}

namespace {

herr_t take_innermost(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

/// The system's error message if HDF5 quotes it, else HDF5's innermost description.
std::string last_reason() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &text);
  constexpr std::string_view kQuote = "error message = '";
  const std::size_t quoted = text.find(kQuote);
  if (quoted == std::string::npos) return text;
  const std::size_t begin = quoted + kQuote.size();
  return text.substr(begin, text.find('\'', begin) - begin);
}

}  // namespace

bool Handle::close() {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  return id < 0 || H5Idec_ref(id) >= 0;
}

QuietErrors::QuietErrors() {
  H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietErrors::~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

void fail(const std::filesystem::path& file, std::string_view what_failed, std::string_view mend) {
  const std::string reason = last_reason();
  if (reason.empty()) throw Error(file.string(), what_failed, mend);
  throw Error(file.string(), fmt::format("{} ({})", what_failed, reason), mend);
}

Handle own(hid_t id, const std::filesystem::path& file, std::string_view what_failed,
           std::string_view mend) {
  if (id < 0) fail(file, what_failed, mend);
  return Handle(id);
}

void require(herr_t result, const std::filesystem::path& file, std::string_view what_failed,
             std::string_view mend) {
  if (result < 0) fail(file, what_failed, mend);
}

}  // namespace pillarfield::hdf5

namespace pillarfield {

std::string hdf5_version() {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

}  // namespace pillarfield
