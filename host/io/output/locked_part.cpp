#include "io/output/locked_part.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {

int write_all(int descriptor, std::span<const std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t put = pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
  }
  return 0;
}

void fail_to_write(const std::filesystem::path& part, int reason) {
  throw Error(part.string(), std::string("cannot be written: ") + std::strerror(reason),
              "check its directory and the space left on its disk");
}

namespace {

/// Limit of Linux.
constexpr int kMaxLinks = 40;

std::filesystem::path output_folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// Applies the rule of Linux's fs.protected_symlinks.
void require_own_link(const std::filesystem::path& link) {
  struct stat folder = {};
  struct stat found = {};
  if (stat(output_folder_of(link).c_str(), &folder) != 0 || lstat(link.c_str(), &found) != 0)
    return;
  constexpr mode_t kForAll = S_ISVTX | S_IWOTH;
  if ((folder.st_mode & kForAll) != kForAll) return;
  if (found.st_uid == geteuid() || found.st_uid == folder.st_uid) return;
  throw Error(link.string(), "is another user's symbolic link in a directory that all may write",
              "choose another name");
}

std::filesystem::path end_of_links(const std::filesystem::path& path) {
  std::filesystem::path end = path;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(end, error));
       ++links) {
    if (links == kMaxLinks) {
      throw Error(path.string(), "is a symbolic link that leads nowhere", "choose another name");
    }
    require_own_link(end);
    const std::filesystem::path target = std::filesystem::read_symlink(end, error);
    if (error) throw Error(path.string(), error.message(), "choose another name");
    end = target.is_absolute() ? target : output_folder_of(end) / target;
  }
  return end;
}

}  // namespace

OutputPlace place_of_output(const std::filesystem::path& path) {
  if (path == "-") {
    throw Error("-", "this output cannot be written to standard output",
                "name a file; for a file named '-' write ./-");
  }
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw Error(path.string(), "exists and is not a regular file", "choose another name");
  }
  OutputPlace place;
  place.final_path = end_of_links(path);
  if (!place.final_path.has_filename()) {
    throw Error(path.string(), path.empty() ? "the name of an output is empty" : "names no file",
                "give the name of a file");
  }
  place.part_path = place.final_path;
  place.part_path += ".part";
  return place;
}

namespace {

constexpr const char* kOtherPart = "remove it, or choose another name";
/// Follows no symbolic link and does not wait for the other end of a pipe.
constexpr int kPartFlags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC | O_NOCTTY;

[[noreturn]] void fail_as_locked(const OutputPlace& place) {
  throw Error(place.final_path.string(), "is being written by another process",
              "choose another name or wait");
}

[[noreturn]] void fail_to_open(const OutputPlace& place, int error_number) {
  if (error_number == ELOOP) {
    throw Error(place.part_path.string(), "is a symbolic link", kOtherPart);
  }
  throw Error(place.part_path.string(), std::strerror(error_number),
              "choose a directory that exists and is writable");
}

void require_plain(const struct stat& found, const OutputPlace& place) {
  const std::string part = place.part_path.string();
  if (S_ISLNK(found.st_mode)) throw Error(part, "is a symbolic link", kOtherPart);
  if (!S_ISREG(found.st_mode)) throw Error(part, "exists and is not a regular file", kOtherPart);
  if (found.st_nlink > 1) throw Error(part, "has several names (hard links)", kOtherPart);
}

struct flock whole_file() {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

bool is_same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

LockedPart::LockedPart(OutputPlace place) : place_(std::move(place)) {
  // A part that is renamed to its final name between open() and the lock is a finished file: leave
  // it and try again.
  constexpr int kMaxTries = 100;
  try {
    for (int tries = 0; !open_and_lock(); ++tries) {
      close(descriptor_);
      descriptor_ = -1;
      if (tries == kMaxTries) fail_as_locked(place_);
    }
    require_unused();
  } catch (...) {
    if (descriptor_ >= 0) close(descriptor_);
    throw;
  }
}

LockedPart::~LockedPart() { close(descriptor_); }

bool LockedPart::open_and_lock() {
  const char* const name = place_.part_path.c_str();
  struct stat found = {};
  was_there_ = lstat(name, &found) == 0;
  if (was_there_) require_plain(found, place_);
  descriptor_ = open(name, O_RDWR | kPartFlags | (was_there_ ? 0 : O_CREAT | O_EXCL), 0666);
  if (descriptor_ < 0) {
    const bool came_or_went = errno == (was_there_ ? ENOENT : EEXIST);
    if (!came_or_went) fail_to_open(place_, errno);
    return false;
  }
  if (!lock()) fail_as_locked(place_);
  if (fstat(descriptor_, &found) != 0) fail_to_open(place_, errno);
  if (!has_its_name()) return false;
  require_plain(found, place_);
  return true;
}

/// Returns false if another process holds the lock. A file system without locks is accepted for a
/// part that this process has created.
bool LockedPart::lock() const {
  struct flock lock = whole_file();
  if (fcntl(descriptor_, F_OFD_SETLK, &lock) == 0) return true;
  if (errno == EAGAIN || errno == EACCES) return false;
  if (!was_there_) return true;
  throw Error(place_.part_path.string(),
              std::string("cannot be locked, and may be written by another process: ") +
                  std::strerror(errno),
              kOtherPart);
}

/// Checks for HDF5 programs, which lock with flock().
void LockedPart::require_unused() const {
  if (!was_there_) return;
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) {
    flock(descriptor_, LOCK_UN);
  } else if (errno == EWOULDBLOCK) {
    throw Error(place_.part_path.string(), "is open in another program",
                "close it there, or choose another name");
  }
}

bool LockedPart::has_its_name() const {
  struct stat named = {};
  struct stat opened = {};
  return lstat(place_.part_path.c_str(), &named) == 0 && fstat(descriptor_, &opened) == 0 &&
         is_same_file(named, opened);
}

bool is_part_left_over(const OutputPlace& place) {
  struct stat found = {};
  if (lstat(place.part_path.c_str(), &found) != 0) return false;
  require_plain(found, place);
  const int descriptor = open(place.part_path.c_str(), O_RDONLY | kPartFlags);
  if (descriptor < 0) return false;
  struct flock lock = whole_file();
  const bool asked = fcntl(descriptor, F_OFD_GETLK, &lock) == 0;
  close(descriptor);
  if (asked && lock.l_type != F_UNLCK) fail_as_locked(place);
  return true;
}

}  // namespace pillarfield
