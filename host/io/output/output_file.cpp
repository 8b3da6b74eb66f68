#include "pillarfield/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "io/output/locked_part.h"
#include "io/output/replaceable.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Returns 0 or errno of fsync(), which some file systems do not support.
int reason_of_sync(int result) {
  return result == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
}

/// Writes a directory to the disk, which makes a rename in it durable. A directory without read
/// permission cannot be opened for that; the system writes it later.
void sync_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const int reason = reason_of_sync(fsync(descriptor));
  close(descriptor);
  if (reason == 0) return;
  throw Error(path.string(),
              std::string("is complete, but its directory was not written to the disk: ") +
                  std::strerror(reason),
              "check the disk");
}

/// Renames a file; replaces an existing one only if `replaces`. Returns 0 or errno.
int rename_to(const std::filesystem::path& from, const std::filesystem::path& to, bool replaces) {
  if (!replaces) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;  // Current file systems support it.
  }
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

bool is_there(const std::filesystem::path& path) {
  struct stat found = {};
  return lstat(path.c_str(), &found) == 0;
}

/// Gives a part the permissions of the file that it replaces, and `more`; file systems without
/// permissions refuse that.
void take_mode(const std::filesystem::path& from, int descriptor, mode_t more = 0) {
  struct stat found = {};
  if (stat(from.c_str(), &found) != 0) return;
  constexpr mode_t kPermissions = S_IRWXU | S_IRWXG | S_IRWXO;
  static_cast<void>(fchmod(descriptor, (found.st_mode & kPermissions) | more));
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path, OutputKind kind, Replace replace)
    : path_(std::move(path)),
      kind_(kind),
      replace_(replace),
      synced_(std::chrono::steady_clock::now()) {
  const OutputPlace place = place_of_output(path_);
  final_path_ = place.final_path;
  part_path_ = place.part_path;
  require_replaceable(final_path_, kind, replace);
  auto part = std::make_unique<LockedPart>(place);
  if (part->was_there()) require_disposable(part_path_, replace);
  take_mode(final_path_, part->descriptor(), S_IRUSR | S_IWUSR);
  if (ftruncate(part->descriptor(), 0) != 0) fail_to_write(part_path_, errno);
  part_ = std::move(part);
}

OutputFile::~OutputFile() {
  if (sync_.valid()) sync_.wait();
  if (part_ == nullptr) return;
  if (kept_) {
    fdatasync(part_->descriptor());
  } else if (part_->has_its_name()) {
    unlink(part_path_.c_str());
  }
}

int OutputFile::descriptor() const { return part_ == nullptr ? -1 : part_->descriptor(); }

void OutputFile::put(std::span<const std::byte> bytes, std::uint64_t offset) {
  if (!is_open()) throw Error(path_.string(), "is finished", "start another file");
  if (const int reason = write_all(descriptor(), bytes, offset); reason != 0) {
    fail_to_write(part_path_, reason);
  }
}

void OutputFile::write(std::span<const std::byte> bytes) {
  put(bytes, size_);
  size_ += bytes.size();
}

void OutputFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void OutputFile::write_at_begin(std::string_view text) { put(std::as_bytes(std::span(text)), 0); }

void OutputFile::take_sync_result() {
  if (!sync_.valid()) return;
  const int reason = sync_.get();
  if (reason != 0) fail_to_write(part_path_, reason);
}

void OutputFile::sync_at_intervals(std::chrono::steady_clock::duration interval) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_open() || now - synced_ < interval) return;
  if (sync_.valid() && sync_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  take_sync_result();
  synced_ = now;
  const auto sync = [descriptor = descriptor()] { return reason_of_sync(fdatasync(descriptor)); };
  try {
    sync_ = std::async(std::launch::async, sync);
  } catch (const std::system_error&) {  // The limit of threads is reached.
    if (const int reason = sync(); reason != 0) fail_to_write(part_path_, reason);
  }
}

/// Renames the part. Checks the final name again, since a file may have appeared there meanwhile.
void OutputFile::take_name() {
  const std::string where_data_are = "the data are complete in " + part_path_.string();
  try {
    require_replaceable(final_path_, kind_, replace_);
  } catch (const Error& error) {
    kept_ = true;
    throw Error("", error.what(), where_data_are);
  }
  take_mode(final_path_, descriptor());
  const int reason = rename_to(part_path_, final_path_, is_there(final_path_));
  if (reason == 0) return;
  kept_ = true;
  throw Error(final_path_.string(), std::string("cannot take its name: ") + std::strerror(reason),
              where_data_are);
}

void OutputFile::commit() {
  if (!is_open()) throw Error(path_.string(), "is finished", "start another file");
  take_sync_result();
  if (const int reason = reason_of_sync(fsync(descriptor())); reason != 0) {
    fail_to_write(part_path_, reason);
  }
  if (!part_->has_its_name()) {
    throw Error(part_path_.string(), "was renamed or removed while it was written",
                "find it under its new name, or write it again");
  }
  flock(descriptor(), LOCK_UN);  // HDF5 may have left a lock, and readers may open the file now.
  take_name();
  part_.reset();
  sync_folder_of(final_path_);
}

}  // namespace pillarfield
