#include "device/private_directory.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

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
  const char* const chosen = std::getenv("TMPDIR");
  std::string reasons;
  for (const char* const parent : {chosen, "/tmp", "/var/tmp", "/dev/shm"}) {
    if (parent == nullptr || !fs::path(parent).is_absolute()) continue;
    std::string name = (fs::path(parent) / "pillarfield-kernels-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      directory_.refused = fmt::format("{} cannot be written: {}", parent, std::strerror(errno));
    } else {
      directory_ = private_directory(name, least_free_bytes);
      if (directory_.refused.empty()) return;
      rmdir(name.c_str());
    }
    reasons += (reasons.empty() ? "" : ", ") + directory_.refused;
  }
  directory_.refused = reasons;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (getpid() == owner_ && !directory_.path.empty()) fs::remove_all(directory_.path, ignored);
}

}  // namespace pillarfield
