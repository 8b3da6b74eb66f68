#include "base/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

[[noreturn]] void fail_to_open(const std::filesystem::path& path) {
  throw Error(path.string(), std::strerror(errno),
              errno == ENOENT || errno == ENOTDIR ? "check its name" : "check its permissions");
}

void require_regular(const struct stat& found, const std::filesystem::path& path) {
  if (S_ISREG(found.st_mode)) return;
  if (S_ISDIR(found.st_mode)) throw Error(path.string(), "is a directory", "name a file in it");
  throw Error(path.string(), "is not a regular file", "copy its content into a file first");
}

/// Looks before it opens, since opening a device may act on it, and again afterwards, since the
/// name may lead to another file by then.
int open_regular(const std::filesystem::path& path, struct stat& found) {
  if (stat(path.c_str(), &found) != 0) fail_to_open(path);
  require_regular(found, path);
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0 || fstat(descriptor, &found) != 0) fail_to_open(path);
  return descriptor;
}

}  // namespace

InputFile::InputFile(std::filesystem::path path, std::uint64_t most_bytes)
    : path_(std::move(path)) {
  struct stat found = {};
  descriptor_ = open_regular(path_, found);
  size_ = static_cast<std::uint64_t>(std::max<off_t>(0, found.st_size));
  try {
    require_regular(found, path_);
    if (size_ <= most_bytes) return;
    throw Error(path_.string(), fmt::format("has {} bytes", size_),
                fmt::format("such a file has {} at most", most_bytes));
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

void InputFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR && !is_interrupted()) continue;
    if (got < 0) throw Error(path_.string(), std::strerror(errno), "use another copy");
    if (got == 0) {
      throw Error(path_.string(), fmt::format("ends at byte {}, before its data", offset),
                  "the file is truncated; use another copy");
    }
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

std::string InputFile::text_at(std::uint64_t offset, std::uint64_t count) const {
  std::string text(offset < size_ ? std::min(count, size_ - offset) : 0, '\0');
  read(offset, std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace pillarfield
