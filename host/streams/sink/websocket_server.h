#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/live.h"
#include "streams/message/topics.h"
#include "streams/sink/address.h"
#include "streams/sink/client_protocol.h"

namespace pillarfield {

/// Limits on clients, none of which is trusted.
struct ServerLimits {
  std::size_t clients = 16;                           ///< connections; the next one is refused
  std::size_t message_bytes = std::size_t{64} << 10;  ///< of a client
  std::size_t invalid_messages = 16;                  ///< then the client is disconnected
  std::size_t queue_bytes = std::size_t{8} << 20;     ///< that wait for one client
  std::size_t controls_per_s = 1000;                  ///< pings and pongs; then disconnected
  double handshake_s = 5;
  double silence_s = 30;                          ///< without an answer to pings
  std::vector<std::string> allowed_origins = {};  ///< as LiveSinkInfo has them
};

/// A message to the clients that want its topic.
struct ServerMessage {
  std::size_t topic = 0;
  std::uint64_t time_ns = 0;
  std::shared_ptr<const std::vector<std::byte>> bytes;
};

/// A WebSocket server in a thread of its own. Web pages must be allowed (refusal_of()). From a
/// client it reads at most 1000 messages and 64 kB a second.
class WebSocketServer {
 public:
  /// Listens; port 0 is any free one. Throws Error, naming `target`, if it cannot.
  WebSocketServer(const SocketAddress& address, const std::string& target,
                  const ServerProtocol& protocol, const ServerLimits& limits = {});
  /// Disconnects all clients.
  ~WebSocketServer();
  WebSocketServer(const WebSocketServer&) = delete;
  WebSocketServer& operator=(const WebSocketServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// Topics that some client wants; any thread may ask.
  [[nodiscard]] TopicSet wanted() const;

  /// Queues the messages of one frame for each client, which loses all of them if its queue is
  /// full. Waits for the server's thread, never for a client.
  void send(std::span<const ServerMessage> messages);

  /// Waits up to a second until the clients have received everything, and closes.
  void finish();

  /// Sets `clients`, `refused` and `notice`, and adds the frames that clients lost; any thread may
  /// ask.
  void add_to(LiveSinkStatistics& statistics) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
