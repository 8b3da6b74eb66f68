#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "device/private_directory.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// Where PoCL, OpenCL on the host's processor, writes compiled kernels, which are libraries that it
/// loads into the process: hence a directory that only root and this user can change, or none.
struct KernelCache {
  std::filesystem::path directory;  ///< empty: there is none, and PoCL offers no device
  std::string not_kept;  ///< why the next process does not find them there; empty where it does
};

/// Chooses the directory by the environment: $POCL_CACHE_DIR, or the first that serves of
/// $XDG_CACHE_HOME/pillarfield/kernels, $HOME/.cache/pillarfield/kernels and, not kept, one of
/// `temporary`, which is made then. What is missing is made. Throws Error where $POCL_CACHE_DIR
/// cannot be written, has too little space, or is not private.
[[nodiscard]] KernelCache choose_kernel_cache(std::unique_ptr<TemporaryDirectory>& temporary);

/// The choice for this process. The first call makes it and sets POCL_CACHE_DIR, by which PoCL
/// learns of it, so it comes before any call of OpenCL. As setenv() does, it excludes that other
/// threads read or change the environment meanwhile. Where the program opened PoCL before, it has
/// no effect.
[[nodiscard]] const KernelCache& kernel_cache();

/// Why kernels of a device could not be written now, as where a disk has become full, which PoCL
/// would end the process for; empty where they can be, or their driver is another.
[[nodiscard]] std::string reason_not_to_compile(const DeviceInfo& device);

}  // namespace pillarfield
