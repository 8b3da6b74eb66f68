#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "streams/message/topics.h"

namespace pillarfield {

/// Whether the server speaks a subprotocol; both are the same so far.
[[nodiscard]] bool is_foxglove_subprotocol(std::string_view name);

/// The first messages to a client: who the server is, and its channels, whose identifiers are the
/// indices of topics().
[[nodiscard]] std::string server_info_json(const std::string& session);
[[nodiscard]] std::string advertise_json();

/// A message for people: 1 warning, 2 error.
[[nodiscard]] std::string status_json(int level, const std::string& message);

/// The first bytes of a binary message that carries data of a channel; the data follow.
inline constexpr std::size_t kMessageDataBytes = 13;
[[nodiscard]] std::array<std::byte, kMessageDataBytes> message_data_head(std::uint32_t subscription,
                                                                         std::uint64_t time_ns);

/// The subscriptions of one client, at most one a topic.
class Subscriptions {
 public:
  /// Obeys a text message of a client, which may hold anything. Returns why it did not obey, or
  /// obeyed in part; empty if it obeyed.
  [[nodiscard]] std::string obey(std::string_view text);

  /// The client's number of its subscription to a topic.
  [[nodiscard]] std::optional<std::uint32_t> of(std::size_t topic) const { return ids_.at(topic); }
  [[nodiscard]] TopicSet topics() const;

 private:
  [[nodiscard]] std::string subscribe(std::uint32_t id, std::uint32_t topic);
  [[nodiscard]] std::string unsubscribe(std::uint32_t id);

  std::array<std::optional<std::uint32_t>, kTopics> ids_;
};

/// Why a server of this computer must not answer a WebSocket request with these headers; empty if
/// it may. Browsers let any page of the web connect, and say only by `Origin` which one.
///
/// `origin` may be absent (a program), "file://" (a program of web technology, or a page from the
/// disk; pages of the web never have it), a page of this computer, or one of `allowed`, such as
/// "https://app.foxglove.dev". `host` may be an IP address, localhost, the name of this computer,
/// or the host of an allowed origin: a name that leads here only since its owner says so (DNS
/// rebinding) is none of these.
[[nodiscard]] std::string refusal_of(std::string_view origin, std::string_view host,
                                     std::span<const std::string> allowed);

}  // namespace pillarfield
