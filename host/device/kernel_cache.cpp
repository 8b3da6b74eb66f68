#include "device/kernel_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

namespace fs = std::filesystem;

/// The reason why others could change the contents of `directory`, which has no links; empty if
/// they cannot. The owner of the root directory is trusted: root, or in a user namespace the id
/// that stands for all users outside of it.
std::string reason_not_private(const fs::path& directory) {
  struct stat root {};
  struct stat facts {};
  lstat("/", &root);
  for (fs::path at = directory;; at = at.parent_path()) {
    if (lstat(at.c_str(), &facts) != 0 || !S_ISDIR(facts.st_mode)) {
      return fmt::format("{} is not a directory", at.string());
    }
    if (facts.st_uid != geteuid() && facts.st_uid != root.st_uid) {
      return fmt::format("{} belongs to another user", at.string());
    }
    const bool is_sticky = at != directory && (facts.st_mode & S_ISVTX) != 0;
    if ((facts.st_mode & (S_IWGRP | S_IWOTH)) != 0 && !is_sticky) {
      return fmt::format("others can write {}", at.string());
    }
    if (!at.has_relative_path()) return {};
  }
}

std::string reason_not_usable(const fs::path& real, std::uintmax_t least_free_bytes) {
  if (std::string reason = reason_not_private(real); !reason.empty()) return reason;
  if (access(real.c_str(), W_OK | X_OK) != 0) {
    return fmt::format("{} cannot be written: {}", real.string(), std::strerror(errno));
  }
  std::error_code unknown;  // A later write reports the error.
  const std::uintmax_t free = fs::space(real, unknown).available;
  if (unknown || free >= least_free_bytes) return {};
  return fmt::format("the disk of {} has {} KiB left, and {} may be needed", real.string(),
                     free >> 10U, least_free_bytes >> 10U);
}

}  // namespace

PrivateDirectory private_directory(const fs::path& wanted, std::uintmax_t least_free_bytes) {
  fs::path made;
  std::error_code failed;
  for (const fs::path& part : wanted) {
    made /= part;
    if (mkdir(made.c_str(), S_IRWXU) == 0 || errno == EEXIST) continue;
    const std::string reason = std::strerror(errno);
    if (fs::exists(made, failed)) continue;  // As in a parent that is read-only.
    return {{}, fmt::format("{} cannot be made: {}", made.string(), reason)};
  }
  const fs::path real = fs::canonical(wanted, failed);
  if (failed) return {{}, fmt::format("{}: {}", wanted.string(), failed.message())};
  std::string refused = reason_not_usable(real, least_free_bytes);
  return {refused.empty() ? real : fs::path(), refused};
}

TemporaryDirectory::TemporaryDirectory(std::uintmax_t least_free_bytes) : owner_(getpid()) {
  std::error_code failed;
  const fs::path parent = fs::temp_directory_path(failed);
  std::string name = (parent / "pillarfield-kernels-XXXXXX").string();
  if (failed || mkdtemp(name.data()) == nullptr) {
    directory_.refused = fmt::format("{} cannot be written", parent.string());
    return;
  }
  directory_ = private_directory(name, least_free_bytes);
  if (!directory_.refused.empty()) rmdir(name.c_str());
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (getpid() == owner_ && !directory_.path.empty()) fs::remove_all(directory_.path, ignored);
}

namespace {

/// A plan's compiled kernels take 0.2 MB; a full disk makes LLVM abort the process.
constexpr std::uintmax_t kLeastFreeBytes = 16U << 20U;

/// No directory can be created below a device file, so PoCL offers no device.
constexpr const char* kNowhere = "/dev/null/pillarfield";

/// An environment variable; empty and unset are the same.
std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The user's directory is used or refused, never replaced by another.
KernelCache cache_of_user(const std::string& wanted) {
  std::error_code failed;
  const PrivateDirectory found = private_directory(fs::absolute(wanted, failed), kLeastFreeBytes);
  if (found.refused.empty()) return {found.path, {}};
  throw Error("POCL_CACHE_DIR", found.refused, "name another that only you can write, or unset it");
}

/// Default directories of kernels, the preferred one first.
std::vector<fs::path> usual_places() {
  std::vector<fs::path> places;
  const fs::path below = fs::path("pillarfield") / "kernels";
  const fs::path caches = environment("XDG_CACHE_HOME");
  const fs::path home = environment("HOME");
  if (caches.is_absolute()) places.push_back(caches / below);
  if (home.is_absolute()) places.push_back(home / ".cache" / below);
  return places;
}

}  // namespace

KernelCache choose_kernel_cache(std::unique_ptr<TemporaryDirectory>& temporary) {
  if (const std::string wanted = environment("POCL_CACHE_DIR"); !wanted.empty()) {
    return cache_of_user(wanted);
  }
  std::string refused;
  for (const fs::path& place : usual_places()) {
    const PrivateDirectory found = private_directory(place, kLeastFreeBytes);
    if (found.refused.empty()) return {found.path, {}};
    refused += (refused.empty() ? "" : ", ") + found.refused;
  }
  if (refused.empty()) refused = "HOME and XDG_CACHE_HOME are not set";
  temporary = std::make_unique<TemporaryDirectory>(kLeastFreeBytes);
  if (!temporary->directory().refused.empty()) refused += ", " + temporary->directory().refused;
  return {temporary->directory().path, refused};
}

namespace {

/// The chosen directory, for the lifetime of the process.
struct ProcessCache {
  ProcessCache() : cache(choose_kernel_cache(temporary)) {
    setenv("POCL_CACHE_DIR", cache.directory.empty() ? kNowhere : cache.directory.c_str(), 1);
  }
  std::unique_ptr<TemporaryDirectory> temporary;
  KernelCache cache;
};

}  // namespace

const KernelCache& kernel_cache() {
  static const ProcessCache chosen;
  return chosen.cache;
}

std::string reason_not_to_compile(const DeviceInfo& device) {
  if (device.kernel_cache.empty() && device.kernels_not_kept.empty()) return {};
  return private_directory(kernel_cache().directory, kLeastFreeBytes).refused;
}

}  // namespace pillarfield
