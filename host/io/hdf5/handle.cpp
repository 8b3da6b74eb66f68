#include "io/hdf5/handle.h"

#include <fmt/format.h>

#include "pillarfield/error.h"
#include "pillarfield/read_options.h"

namespace pillarfield::hdf5 {
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
