#include "streams/sink/web_access.h"

#include <fmt/format.h>
#include <strings.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <optional>

namespace pillarfield {
namespace {

bool same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && strncasecmp(a.data(), b.data(), a.size()) == 0;
}

/// "NAME" of "NAME:PORT", "[ADDRESS]:PORT" and "NAME"; "" of anything else.
std::string_view without_port(std::string_view host) {
  const bool is_bracketed = host.starts_with('[');
  const std::size_t end = is_bracketed ? host.find(']') : std::min(host.find(':'), host.size());
  if (end == std::string_view::npos) return {};
  const std::string_view name = host.substr(is_bracketed ? 1 : 0, is_bracketed ? end - 1 : end);
  const std::string_view behind = host.substr(is_bracketed ? end + 1 : end);
  const bool has_port = behind.size() > 1 && behind[0] == ':' &&
                        behind.find_first_not_of("0123456789", 1) == std::string_view::npos;
  return behind.empty() || has_port ? name : std::string_view();
}

/// The part after "http://" or "https://"; none for another origin.
std::optional<std::string_view> host_of_page(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (same_name(origin.substr(0, scheme.size()), scheme)) return origin.substr(scheme.size());
  }
  return std::nullopt;
}

std::optional<boost::asio::ip::address> address_in(std::string_view host) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(std::string(without_port(host)), error);
  if (error) return std::nullopt;
  return address;
}

bool is_loopback(std::string_view host) {
  const auto address = address_in(host);
  return same_name(without_port(host), "localhost") || (address && address->is_loopback());
}

bool is_name_of_this_computer(std::string_view host) {
  std::array<char, 256> name = {};
  if (gethostname(name.data(), name.size() - 1) != 0) return false;
  return same_name(host, name.data()) || same_name(host, std::string(name.data()) + ".local");
}

/// A page that this server sent has its host.
bool may_ask(std::string_view origin, std::string_view host, std::span<const std::string> allowed) {
  if (origin.empty() || origin == "file://") return true;
  const auto page = host_of_page(origin);
  if (page && (is_loopback(*page) || same_name(*page, host))) return true;
  return std::ranges::any_of(allowed,
                             [&](const std::string& each) { return same_name(each, origin); });
}

bool may_be_asked(std::string_view host, std::span<const std::string> allowed) {
  if (address_in(host) || is_loopback(host) || is_name_of_this_computer(without_port(host))) {
    return true;
  }
  return std::ranges::any_of(allowed, [&](const std::string& each) {
    const auto page = host_of_page(each);
    const std::string_view name = page ? without_port(*page) : "";
    return !name.empty() && same_name(name, without_port(host));
  });
}

}  // namespace

std::string refusal_of(std::string_view origin, std::string_view host,
                       std::span<const std::string> allowed) {
  constexpr std::size_t kMostShown = 200;
  if (!may_ask(origin, host, allowed)) {
    return fmt::format("refused the web page {0}; --allow-origin {0} admits it",
                       origin.substr(0, kMostShown));
  }
  if (!may_be_asked(host, allowed)) {
    return fmt::format(
        "refused a client that asked for the host '{0}'; --allow-origin http://{0} "
        "admits it",
        host.substr(0, std::min(host.rfind(':'), kMostShown)));
  }
  return "";
}

std::string http_answer(std::string_view status, std::string_view type, std::string_view text) {
  return fmt::format(
      "HTTP/1.1 {}\r\nServer: pillarfield\r\nContent-Type: {}; charset=utf-8\r\n"
      "Content-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n"
      "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src "
      "'unsafe-inline'; img-src data:; connect-src 'self'; frame-ancestors 'none'\r\n\r\n{}",
      status, type, text.size(), text);
}

}  // namespace pillarfield
