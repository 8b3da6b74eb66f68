#include "cli/stream/control_place.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <cstdlib>
#include <cstring>

#include "pillarfield/error.h"

namespace pillarfield::cli {

std::string control_place(const std::string& name) {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  const bool has_folder = folder != nullptr && folder[0] == '/';
  if (!has_folder || name.empty() || name.find('/') != std::string::npos) return name;
  return fmt::format("{}/{}", folder, name);
}

sockaddr_un control_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw Error(path, "the name of the control socket is too long",
                fmt::format("give at most {} bytes", sizeof address.sun_path - 1));
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

}  // namespace pillarfield::cli
