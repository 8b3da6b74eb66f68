#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pillarfield {

/// A directory in which only root and this user can change anything, or why there is none.
struct PrivateDirectory {
  std::filesystem::path path;  ///< absolute and without links; empty where `refused` says why
  std::string refused;
};

/// Makes `wanted` and what is missing above it for this user alone. It is refused where it cannot
/// be made or written, where its disk has less than `least_free_bytes` left for this user, and
/// where others could change what lies in it: where a directory on the way belongs to them or they
/// may write it, save a sticky one such as /tmp, in which they cannot rename what is not theirs.
[[nodiscard]] PrivateDirectory private_directory(const std::filesystem::path& wanted,
                                                 std::uintmax_t least_free_bytes);

/// A new private directory in $TMPDIR, /tmp, /var/tmp or /dev/shm, the first that serves. It is
/// removed with the object, in the process that made it; those of processes that were killed are
/// removed when the next one is made.
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
  int lock_ = -1;  ///< a descriptor of the directory, locked for as long as it is in use
  int owner_;      ///< the process that made it: one that is forked from it does not remove it
};

}  // namespace pillarfield
