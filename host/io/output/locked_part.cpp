#include "io/output/locked_part.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
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
    bytes_.emplace(descriptor_);
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
