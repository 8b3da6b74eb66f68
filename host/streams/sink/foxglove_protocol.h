#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "streams/message/topics.h"
#include "streams/sink/client_protocol.h"

namespace pillarfield {

/// The bytes before the data of a message of a channel.
inline constexpr std::size_t kMessageDataBytes = 13;

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

/// `foxglove.sdk.v1` and `foxglove.websocket.v1`, which are the same so far. The identifiers of
/// channels are the indices of topics().
[[nodiscard]] ServerProtocol foxglove_protocol();

}  // namespace pillarfield
