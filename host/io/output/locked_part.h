#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace pillarfield {

/// Writes all bytes from an offset on. Returns 0 or errno.
[[nodiscard]] int write_all(int descriptor, std::span<const std::byte> bytes, std::uint64_t offset);

/// Throws Error about a part with the reason, an errno.
[[noreturn]] void fail_to_write(const std::filesystem::path& part, int reason);

/// Names of an output while it is written and when it is complete.
struct OutputPlace {
  std::filesystem::path final_path;
  std::filesystem::path part_path;  ///< the final path and ".part"
};

/// Follows the symbolic links at `path`. Throws Error if `path` names no file, something other than
/// a regular file, or another user's link in a directory that everybody may write.
[[nodiscard]] OutputPlace place_of_output(const std::filesystem::path& path);

/// The part of an output, open and locked against other writers, before anything is written to it.
///
/// The lock is an open file description lock (fcntl). It ends with the last duplicate of the
/// descriptor, at the latest with the process, and is independent of HDF5's own locks (flock).
class LockedPart {
 public:
  /// Creates the part, or opens one that an earlier writer left. Throws Error if another process
  /// writes it, or if it is a symbolic link, has other names, or is not a regular file.
  explicit LockedPart(OutputPlace place);
  ~LockedPart();
  LockedPart(const LockedPart&) = delete;
  LockedPart& operator=(const LockedPart&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool was_there() const { return was_there_; }

  /// True if the part's name still refers to this file.
  [[nodiscard]] bool has_its_name() const;

 private:
  bool open_and_lock();
  void require_unused() const;
  [[nodiscard]] bool lock() const;

  OutputPlace place_;
  int descriptor_ = -1;
  bool was_there_ = false;
};

/// True if a part exists that LockedPart would open. Throws Error in the cases of LockedPart.
[[nodiscard]] bool is_part_left_over(const OutputPlace& place);

}  // namespace pillarfield
