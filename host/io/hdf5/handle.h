#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace pillarfield::hdf5 {

/// Name of a type for messages: "uint8", "float64", "a string", "a compound".
[[nodiscard]] std::string name_of_type(hid_t type);

/// Throws Error, naming the type, unless `type` is a standard integer of 1, 2, 4 or 8 bytes or an
/// IEEE float of 2, 4 or 8, in either byte order. HDF5 crashes when it converts some other number
/// types. `what` names the attribute or dataset.
void require_number(const std::filesystem::path& file, std::string_view what, hid_t type);

/// Owns an HDF5 identifier of any kind.
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  ~Handle() { (void)close(); }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }

  /// Releases the identifier; false if HDF5 could not write the remaining data.
  [[nodiscard]] bool close();

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// While it exists, HDF5 does not print its error stack in this thread. Every public function that
/// calls HDF5 begins with one.
///
/// It also disables HDF5's cleanup at exit, unless HDF5 was used before: after a damaged file the
/// cleanup of HDF5 1.10 prints errors. Handles close everything they opened.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Advice for a file that HDF5 cannot parse.
inline constexpr const char* kDamaged = "the file is damaged or truncated; use another copy";

/// Throws Error about `file` with HDF5's reason for the last failed call.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what_failed,
                       std::string_view mend = {});

/// Owns the identifier that an HDF5 call returned; fails with `what_failed` if it is negative.
[[nodiscard]] Handle own(hid_t id, const std::filesystem::path& file, std::string_view what_failed,
                         std::string_view mend = {});

/// Fails with `what_failed` if an HDF5 call returned a negative `result`.
void require(herr_t result, const std::filesystem::path& file, std::string_view what_failed,
             std::string_view mend = {});

}  // namespace pillarfield::hdf5
