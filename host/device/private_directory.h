#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pillarfield {

/// A directory that only root and this user can change, or the reason why there is none.
struct PrivateDirectory {
  std::filesystem::path path;  ///< absolute, without links; empty if refused
  std::string refused;         ///< the reason
};

/// Creates `wanted` and its missing parents with access for this user alone. Refuses it if it
/// cannot be created or written, if its disk has less than `least_free_bytes` for this user, or if
/// others could change its contents: if they own or can write a directory on its path, except a
/// sticky one such as /tmp.
[[nodiscard]] PrivateDirectory private_directory(const std::filesystem::path& wanted,
                                                 std::uintmax_t least_free_bytes);

/// Removes the temporary directories of killed processes, which are not locked.
void remove_left_over_directories();

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
  bool make_in(const std::filesystem::path& parent, std::uintmax_t least_free_bytes);

  PrivateDirectory directory_;
  int lock_ = -1;  ///< locked descriptor of the directory
  int owner_;      ///< the process that created it
};

}  // namespace pillarfield
