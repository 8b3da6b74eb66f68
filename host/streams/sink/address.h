#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace pillarfield {

/// A socket address.
struct SocketAddress {
  sockaddr_storage storage = {};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
};

/// "ADDRESS:PORT" at which this computer reaches a server that listens at `address`, which may be
/// any of its own; IPv6 in brackets.
[[nodiscard]] std::string place_to_open(const SocketAddress& address, std::uint16_t port);

/// The address of "HOST:PORT": HOST is numeric or "localhost". Throws Error, naming `target`, for
/// another text or a port outside [lowest_port, 65535].
[[nodiscard]] SocketAddress address_of(std::string_view text, const std::string& target,
                                       int lowest_port);

}  // namespace pillarfield
