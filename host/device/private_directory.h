#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pillarfield {

/// A directory that only this user can change, or the reason why there is none.
struct PrivateDirectory {
  std::filesystem::path path;  ///< absolute, without links; empty if refused
  std::string refused;         ///< the reason
};

/// Creates `wanted` and its missing parents with access for this user alone. Refuses it if it
/// cannot be created or written, if its disk has less than `least_free_bytes` for this user, or if
/// others own it or can write it, or a directory above that is not sticky as /tmp is.
[[nodiscard]] PrivateDirectory private_directory(const std::filesystem::path& wanted,
                                                 std::uintmax_t least_free_bytes);

/// A new private directory in the first usable of $TMPDIR, /tmp, /var/tmp and /dev/shm. The
/// destructor removes it in the process that created it.
class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(std::uintmax_t least_free_bytes);
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const PrivateDirectory& directory() const { return directory_; }

 private:
  PrivateDirectory directory_;
  int owner_;  ///< the process that created it
};

}  // namespace pillarfield
