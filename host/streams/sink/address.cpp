#include "streams/sink/address.h"

#include <fmt/format.h>
#include <netdb.h>

#include <array>
#include <charconv>
#include <cstring>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"

namespace pillarfield {
namespace {

constexpr const char* kLoopback = "127.0.0.1";

bool is_port(std::string_view text, int lowest) {
  int port = -1;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  return error == std::errc() && rest == end && port >= lowest && port <= 65535;
}

struct HostAndPort {
  std::string host;
  std::string port;
};

/// Splits "HOST:PORT", "[IPV6]:PORT", ":PORT" and "PORT"; without a host it is 127.0.0.1.
HostAndPort split_address(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return {kLoopback, std::string(text)};
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host == "localhost" || host.empty()) host = kLoopback;
  return {std::string(host), std::string(text.substr(colon + 1))};
}

}  // namespace

std::string place_to_open(const SocketAddress& address, std::uint16_t port) {
  std::array<char, NI_MAXHOST> text{};
  getnameinfo(address.get(), address.size, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST);
  std::string host = text.data();
  if (host == "0.0.0.0") host = kLoopback;
  if (host == "::") host = "::1";
  const bool is_v6 = host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", is_v6 ? "[" : "", host, is_v6 ? "]" : "", port);
}

SocketAddress address_of(std::string_view text, const std::string& target, int lowest_port) {
  const HostAndPort parts = split_address(text);
  if (!is_port(parts.port, lowest_port)) {
    throw Error(printable(target), fmt::format("'{}' is not a port", printable(parts.port)),
                fmt::format("give a number from {} to 65535", lowest_port));
  }
  addrinfo hints = {};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found) != 0) {
    throw Error(printable(target), fmt::format("'{}' is no IP address", printable(parts.host)),
                "give one such as 127.0.0.1 or [::1]");
  }
  SocketAddress address;
  address.size = found->ai_addrlen;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  return address;
}

}  // namespace pillarfield
