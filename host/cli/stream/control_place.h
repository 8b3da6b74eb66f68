#pragma once

#include <sys/un.h>

#include <string>

namespace pillarfield::cli {

/// The path of a control socket: a name without a slash lies in $XDG_RUNTIME_DIR, which only this
/// user may enter, where that is set.
[[nodiscard]] std::string control_place(const std::string& name);

/// Throws Error if the path is too long for a socket.
[[nodiscard]] sockaddr_un control_address(const std::string& path);

}  // namespace pillarfield::cli
