#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "streams/message/topics.h"

namespace pillarfield {

/// Messages of a WebSocketServer to one client, and the client's requests. Topics are numbers that
/// the protocol gives them, below kTopics.
class ClientProtocol {
 public:
  ClientProtocol() = default;
  virtual ~ClientProtocol() = default;
  ClientProtocol(const ClientProtocol&) = delete;
  ClientProtocol& operator=(const ClientProtocol&) = delete;

  /// The first text messages to the client.
  [[nodiscard]] virtual std::vector<std::string> greeting() const { return {}; }

  /// Obeys a text message of the client, which may hold anything. Returns why it did not obey, or
  /// obeyed in part; empty if it obeyed.
  [[nodiscard]] virtual std::string obey(std::string_view text) = 0;
  /// The text message that tells the client why.
  [[nodiscard]] virtual std::string complaint(const std::string& why) const = 0;

  /// The topics whose next message the client gets.
  [[nodiscard]] virtual TopicSet topics() const = 0;
  /// The bytes before the data of a message of one of these topics; the message is sent.
  [[nodiscard]] virtual std::vector<std::byte> take_head(std::size_t topic,
                                                         std::uint64_t time_ns) = 0;
};

/// The protocol and the page of a WebSocketServer.
struct ServerProtocol {
  std::vector<std::string> names;                           ///< subprotocols
  std::function<std::unique_ptr<ClientProtocol>()> create;  ///< for a new client
  std::string page = {};                                    ///< HTML at "/"; empty: none
};

}  // namespace pillarfield
