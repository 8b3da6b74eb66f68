#include "device/private_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace pillarfield {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporaryPrefix = "pillarfield-kernels-";

/// The user id that stands for all users outside of a user namespace, root included; none outside
/// of such a namespace, where that id is an ordinary user.
std::optional<uid_t> id_of_outer_users() {
  std::ifstream map("/proc/self/uid_map");
  std::uint64_t inside = 0;
  std::uint64_t outside = 0;
  std::uint64_t count = 0;
  if (!(map >> inside >> outside >> count)) return std::nullopt;
  if (inside == 0 && outside == 0 && count >= 0xffffffffU) return std::nullopt;
  uid_t id = 0;
  if (!(std::ifstream("/proc/sys/kernel/overflowuid") >> id)) return std::nullopt;
  return id;
}

bool is_trusted(uid_t owner) {
  return owner == 0 || owner == geteuid() || owner == id_of_outer_users();
}

/// True if the group is private to the owner and has the owner's name: many systems give each user
/// such a group with write access.
bool is_of_owner_alone(gid_t group, uid_t owner) {
  std::array<char, 16384> user_text{};
  std::array<char, 16384> group_text{};
  passwd user{};
  ::group members{};
  passwd* found_user = nullptr;
  ::group* found_group = nullptr;
  getpwuid_r(owner, &user, user_text.data(), user_text.size(), &found_user);
  getgrgid_r(group, &members, group_text.data(), group_text.size(), &found_group);
  if (found_user == nullptr || found_group == nullptr) return false;
  if (std::strcmp(user.pw_name, members.gr_name) != 0) return false;
  for (char** member = members.gr_mem; *member != nullptr; ++member) {
    if (std::strcmp(*member, user.pw_name) != 0) return false;
  }
  return true;
}

bool may_be_written_by_others(const fs::path& directory, const struct stat& facts) {
  if ((facts.st_mode & S_IWOTH) != 0) return true;
  if ((facts.st_mode & S_IWGRP) == 0) return false;
  // With an access control list, the group's bits are the upper limit of its entries.
  if (getxattr(directory.c_str(), "system.posix_acl_access", nullptr, 0) > 0) return true;
  return !is_of_owner_alone(facts.st_gid, facts.st_uid);
}

/// Why others could change the contents of `directory`, which has no links; empty if they cannot.
/// Sets `shared` if they can create entries in it, as in /tmp.
std::string reason_not_private(const fs::path& directory, bool& shared) {
  fs::path parent;
  for (const fs::path& part : directory) {
    parent /= part;
    struct stat facts {};
    if (lstat(parent.c_str(), &facts) != 0) {
      return fmt::format("{}: {}", parent.string(), std::strerror(errno));
    }
    if (!S_ISDIR(facts.st_mode)) return fmt::format("{} is not a directory", parent.string());
    if (!is_trusted(facts.st_uid)) {
      return fmt::format("{} belongs to another user", parent.string());
    }
    shared = may_be_written_by_others(parent, facts);
    if (shared && (facts.st_mode & S_ISVTX) == 0) {
      return fmt::format("others can write {}", parent.string());
    }
  }
  return {};
}

/// Why others could change the nearest existing directory above `wanted`; empty if they cannot.
std::string reason_not_to_make(fs::path wanted) {
  std::error_code failed;
  while (wanted.has_relative_path() && !fs::exists(fs::symlink_status(wanted, failed))) {
    wanted = wanted.parent_path();
  }
  const fs::path real = fs::canonical(wanted, failed);
  if (failed) return fmt::format("{}: {}", wanted.string(), failed.message());
  bool shared = false;
  return reason_not_private(real, shared);
}

/// Creates the directory and its missing parents; returns why it cannot.
std::string make_directories(const fs::path& directory) {
  if (std::string reason = reason_not_to_make(directory); !reason.empty()) return reason;
  fs::path made;
  for (const fs::path& part : directory) {
    made /= part;
    if (mkdir(made.c_str(), S_IRWXU) == 0 || errno == EEXIST) continue;
    const std::string reason = std::strerror(errno);
    std::error_code failed;
    if (fs::exists(made, failed)) continue;  // As in a parent that is read-only.
    return fmt::format("{} cannot be made: {}", made.string(), reason);
  }
  return {};
}

std::string reason_not_usable(const fs::path& real, std::uintmax_t least_free_bytes) {
  bool shared = false;
  if (std::string reason = reason_not_private(real, shared); !reason.empty()) return reason;
  if (shared) return fmt::format("others can write {}", real.string());
  if (faccessat(AT_FDCWD, real.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    return fmt::format("{} cannot be written: {}", real.string(), std::strerror(errno));
  }
  struct statvfs disk {};
  if (statvfs(real.c_str(), &disk) != 0) return {};  // A later write reports the error.
  const std::uintmax_t free = std::uintmax_t{disk.f_bavail} * disk.f_frsize;
  if (free >= least_free_bytes) return {};
  return fmt::format("the disk of {} has {} KiB left, and {} may be needed", real.string(),
                     free >> 10U, least_free_bytes >> 10U);
}

void remove_left_over_in(const fs::path& parent) {
  std::error_code ignored;  // Directories that cannot be removed stay.
  for (fs::directory_iterator entry(parent, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const fs::path path = entry->path();
    if (!path.filename().string().starts_with(kTemporaryPrefix)) continue;
    const int directory = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (directory < 0) continue;
    struct stat facts {};
    const bool ours = fstat(directory, &facts) == 0 && facts.st_uid == geteuid();
    if (ours && flock(directory, LOCK_EX | LOCK_NB) == 0) fs::remove_all(path, ignored);
    close(directory);
  }
}

std::vector<fs::path> temporary_parents() {
  std::vector<fs::path> parents;
  const char* const chosen = std::getenv("TMPDIR");
  if (chosen != nullptr && fs::path(chosen).is_absolute()) parents.emplace_back(chosen);
  for (const char* const usual : {"/tmp", "/var/tmp", "/dev/shm"}) parents.emplace_back(usual);
  return parents;
}

}  // namespace

void remove_left_over_directories() {
  for (const fs::path& parent : temporary_parents()) remove_left_over_in(parent);
}

PrivateDirectory private_directory(const fs::path& wanted, std::uintmax_t least_free_bytes) {
  if (std::string reason = make_directories(wanted); !reason.empty()) return {{}, reason};
  std::error_code failed;
  const fs::path real = fs::canonical(wanted, failed);
  if (failed) return {{}, fmt::format("{}: {}", wanted.string(), failed.message())};
  if (std::string reason = reason_not_usable(real, least_free_bytes); !reason.empty()) {
    return {{}, reason};
  }
  return {real, {}};
}

TemporaryDirectory::TemporaryDirectory(std::uintmax_t least_free_bytes) : owner_(getpid()) {
  std::string reasons;
  for (const fs::path& parent : temporary_parents()) {
    if (make_in(parent, least_free_bytes)) return;
    reasons += (reasons.empty() ? "" : ", ") + directory_.refused;
  }
  directory_.refused = reasons;
}

bool TemporaryDirectory::make_in(const fs::path& parent, std::uintmax_t least_free_bytes) {
  directory_ = {};
  std::error_code failed;
  const fs::path real = fs::canonical(parent, failed);
  if (failed) {
    directory_.refused = fmt::format("{}: {}", parent.string(), failed.message());
    return false;
  }
  std::string name = (real / kTemporaryPrefix).string() + "XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {
    directory_.refused =
        fmt::format("{} cannot be written: {}", real.string(), std::strerror(errno));
    return false;
  }
  lock_ = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ >= 0) flock(lock_, LOCK_EX);
  if (!fs::exists(name, failed)) {  // Taken for a left one before it was locked.
    if (lock_ >= 0) close(std::exchange(lock_, -1));
    return make_in(parent, least_free_bytes);
  }
  directory_ = private_directory(name, least_free_bytes);
  if (directory_.refused.empty()) return true;
  rmdir(name.c_str());
  if (lock_ >= 0) close(std::exchange(lock_, -1));
  return false;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  if (getpid() == owner_ && !directory_.path.empty()) fs::remove_all(directory_.path, ignored);
  if (lock_ >= 0) close(lock_);
}

}  // namespace pillarfield
