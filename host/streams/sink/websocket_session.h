#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include "streams/sink/websocket_server.h"

namespace pillarfield {

/// A connection to a WebSocketServer, used by the server's thread.
class Session {
 public:
  Session() = default;
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Queues the messages that the client wants.
  virtual void send(std::span<const ServerMessage> messages) = 0;
  [[nodiscard]] virtual bool is_idle() const = 0;  ///< nothing waits
  [[nodiscard]] virtual TopicSet wanted() const = 0;
  /// Ends the connection in an orderly way.
  virtual void close() = 0;
};

/// What sessions share; used by the server's thread alone, but for the atomic members.
struct Hub {
  ServerLimits limits;
  ServerProtocol protocol;
  std::string session_id = {};
  std::set<std::shared_ptr<Session>> sessions = {};
  std::atomic<std::uint64_t> clients = 0;
  std::atomic<std::uint64_t> refused = 0;
  std::atomic<std::uint64_t> lost = 0;
  std::atomic<unsigned long> wanted = 0;
  mutable std::mutex mutex = {};  ///< guards `notice`
  std::string notice = {};        ///< why a client was refused; the first one

  void update_wanted();
};

/// Adds a session of `hub`, which removes itself when its connection ends.
void start_session(boost::asio::ip::tcp::socket socket, Hub& hub);

}  // namespace pillarfield
