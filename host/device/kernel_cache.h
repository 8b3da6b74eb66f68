#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "device/private_directory.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// Directory where PoCL, OpenCL on the host's processor, writes compiled kernels. It loads them
/// into the process as libraries, so only this user may write there.
struct KernelCache {
  std::filesystem::path directory;  ///< empty: none, and PoCL offers no device
  std::string
      not_kept;  ///< the reason why the next process cannot reuse the kernels; empty if it can
};

/// Chooses the directory: $POCL_CACHE_DIR, or the first usable one of
/// $XDG_CACHE_HOME/pillarfield/kernels, $HOME/.cache/pillarfield/kernels and a new `temporary` one.
/// Creates missing directories, and removes programs that no process has used for 30 days. Throws
/// Error if $POCL_CACHE_DIR is not writable, has too little space, or is not private.
[[nodiscard]] KernelCache choose_kernel_cache(std::unique_ptr<TemporaryDirectory>& temporary);

/// The directory of this process. The first call chooses it and sets POCL_CACHE_DIR for PoCL, so it
/// must precede all OpenCL calls. Like setenv(), it must not run while other threads use the
/// environment. It has no effect if the program has opened PoCL before.
[[nodiscard]] const KernelCache& kernel_cache();

/// The reason why kernels of a device cannot be written, for instance because the disk is full:
/// PoCL would abort the process. Empty if they can, or if the driver is not PoCL.
[[nodiscard]] std::string reason_not_to_compile(const DeviceInfo& device);

}  // namespace pillarfield
