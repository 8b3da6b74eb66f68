#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace pillarfield::hdf5 {

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

  /// Releases the identifier; false where HDF5 could not write what was left to write.
  [[nodiscard]] bool close();

 private:
  hid_t id_ = H5I_INVALID_HID;
};

/// Keeps HDF5 from printing its error stack, in this thread, while it lives. Every public function
/// that reaches HDF5 begins with one.
///
/// It also keeps HDF5 from tidying up when the process exits, unless something else has used HDF5
/// before: after a damaged file HDF5 1.10 would print that it cannot. Handles close all that they
/// opened themselves.
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

/// How to mend a file in which HDF5 finds no sense.
inline constexpr const char* kDamaged = "the file is damaged or truncated; take another copy";

/// Throws Error about `file`, with the reason that HDF5 gave for the call that failed last.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what_failed,
                       std::string_view mend = {});

/// Takes the identifier that an HDF5 call returned, or fails with `what_failed`.
[[nodiscard]] Handle own(hid_t id, const std::filesystem::path& file, std::string_view what_failed,
                         std::string_view mend = {});

/// Fails with `what_failed` where an HDF5 call returned a negative `result`.
void require(herr_t result, const std::filesystem::path& file, std::string_view what_failed,
             std::string_view mend = {});

}  // namespace pillarfield::hdf5
