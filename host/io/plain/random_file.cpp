#include "io/plain/random_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {

RandomFile::RandomFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(open(path_.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat found = {};
  if (descriptor_ >= 0 && fstat(descriptor_, &found) == 0) {
    size_ = static_cast<std::uint64_t>(std::max<off_t>(0, found.st_size));
    return;
  }
  const int failure = errno;
  if (descriptor_ >= 0) close(descriptor_);
  throw Error(path_.string(), std::strerror(failure), "check its permissions");
}

RandomFile::~RandomFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

RandomFile::RandomFile(RandomFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

void RandomFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(path_.string(), std::strerror(errno), "use another copy");
    if (got == 0) {
      throw Error(path_.string(), fmt::format("ends at byte {}, before its data", offset),
                  "the file is truncated; use another copy");
    }
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

std::string RandomFile::text_at(std::uint64_t offset, std::uint64_t count) const {
  std::string text(offset < size_ ? std::min(count, size_ - offset) : 0, '\0');
  read(offset, std::as_writable_bytes(std::span(text)));
  return text;
}

}  // namespace pillarfield
