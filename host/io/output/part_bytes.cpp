#include "io/output/part_bytes.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Size of the file, or 0 if it is unknown: then it counts as shortened.
std::uint64_t size_of_file(int descriptor) {
  struct stat found = {};
  return fstat(descriptor, &found) == 0 ? static_cast<std::uint64_t>(found.st_size) : 0;
}

}  // namespace

int PartBytes::write(std::span<const std::byte> bytes, std::uint64_t offset) {
  // Before each write, since a write beyond the end hides that the file was shortened.
  if (size_of_file(descriptor_) < end_) return ESTALE;
  if (offset < head_.size()) {
    std::ranges::copy(bytes.first(std::min<std::size_t>(bytes.size(), head_.size() - offset)),
                      head_.begin() + static_cast<std::ptrdiff_t>(offset));
  }
  while (!bytes.empty()) {
    const ssize_t put = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
    end_ = std::max(end_, offset);
  }
  return 0;
}

int PartBytes::resize(std::uint64_t bytes) {
  if (size_of_file(descriptor_) < end_) return ESTALE;
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) return errno;
  end_ = bytes;
  return 0;
}

int PartBytes::check() const {
  std::array<std::byte, 64> head{};
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(end_, head.size()));
  const bool is_read = pread(descriptor_, head.data(), count, 0) == static_cast<ssize_t>(count);
  return size_of_file(descriptor_) == end_ && is_read && head == head_ ? 0 : ESTALE;
}

void fail_to_write(const std::filesystem::path& part, int reason) {
  if (reason == ESTALE) {
    throw Error(part.string(),
                "was shortened or overwritten by another program while it was written",
                "write it again");
  }
  throw Error(part.string(), std::string("cannot be written: ") + std::strerror(reason),
              "check its directory and the space left on its disk");
}

}  // namespace pillarfield
