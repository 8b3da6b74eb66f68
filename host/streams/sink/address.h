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

/// An address and a port as text.
struct HostAndPort {
  std::string host;
  std::string port;
};

/// Splits "HOST:PORT", "[IPV6]:PORT", ":PORT" and "PORT"; without a host it is 127.0.0.1.
[[nodiscard]] HostAndPort split_address(std::string_view text);

/// "HOST:PORT", with brackets around an IPv6 address.
[[nodiscard]] std::string host_and_port(const std::string& host, std::uint16_t port);

/// The address of "HOST:PORT": HOST is numeric or "localhost". Throws Error, naming `target`, for
/// another text or a port outside [lowest_port, 65535].
[[nodiscard]] SocketAddress address_of(std::string_view text, const std::string& target,
                                       int lowest_port);

}  // namespace pillarfield
