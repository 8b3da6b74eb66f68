#include "streams/source/byte_source.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace pillarfield {

bool wait_readable(int descriptor, std::chrono::nanoseconds timeout) {
  pollfd polled = {descriptor, POLLIN, 0};
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(timeout);
  const timespec wait = {.tv_sec = whole.count(), .tv_nsec = (timeout - whole).count()};
  return ppoll(&polled, 1, &wait, nullptr) > 0;
}

BytesRead read_bytes(int descriptor, std::span<std::byte> space, std::chrono::nanoseconds timeout) {
  if (!wait_readable(descriptor, timeout)) return {};
  const ssize_t size = read(descriptor, space.data(), space.size());
  if (size > 0) return {static_cast<std::size_t>(size), false};
  const bool may_go_on = size < 0 && (errno == EINTR || errno == EAGAIN);
  return {0, !may_go_on};
}

}  // namespace pillarfield
