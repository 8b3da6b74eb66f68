#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/processor.h"

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

/// A new private directory in $TMPDIR or /tmp. The destructor removes it in the process that
/// created it.
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

/// Directory where PoCL, OpenCL on the host's processor, writes compiled kernels. It loads them
/// into the process as libraries, so only this user may write there.
struct KernelCache {
  std::filesystem::path directory;  ///< empty: none, and PoCL offers no device
  std::string
      not_kept;  ///< the reason why the next process cannot reuse the kernels; empty if it can
};

/// Chooses the directory: $POCL_CACHE_DIR, or the first usable one of
/// $XDG_CACHE_HOME/pillarfield/kernels, $HOME/.cache/pillarfield/kernels and a new `temporary` one.
/// Creates missing directories. Throws Error if $POCL_CACHE_DIR is not writable, has too little
/// space, or is not private.
[[nodiscard]] KernelCache choose_kernel_cache(std::unique_ptr<TemporaryDirectory>& temporary);

/// The directory of this process. The first call chooses it and sets POCL_CACHE_DIR for PoCL, so it
/// must precede all OpenCL calls. Like setenv(), it must not run while other threads use the
/// environment. It has no effect if the program has opened PoCL before.
[[nodiscard]] const KernelCache& kernel_cache();

/// The reason why kernels of a device cannot be written, for instance because the disk is full:
/// PoCL would abort the process. Empty if they can, or if the driver is not PoCL.
[[nodiscard]] std::string reason_not_to_compile(const DeviceInfo& device);

}  // namespace pillarfield
