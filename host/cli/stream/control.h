#pragma once

#include <sys/un.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield::cli {

/// Lines of text from clients, and answers to them: a Unix-domain socket that only this user may
/// open, or standard input and output. At most 8 clients; a line has at most 4096 bytes.
class ControlChannel {
 public:
  /// `path`: of the socket, as control_place() takes it; "-": standard input and output; empty: no
  /// channel. Throws Error if another program listens there, or the socket cannot be made.
  explicit ControlChannel(const std::string& path);
  ~ControlChannel();  ///< removes the socket
  ControlChannel(const ControlChannel&) = delete;
  ControlChannel& operator=(const ControlChannel&) = delete;

  /// Handles what has arrived, without waiting: calls `handle` for each line and sends its answer
  /// as a line. Where `handle` returns nothing, answer() must follow, for which a client that has
  /// ended its lines is kept. Does nothing within 20 ms of the last call that did.
  void poll(const std::function<std::string(std::uint64_t client, std::string_view line)>& handle);

  /// Sends a later answer; does nothing if the client is gone.
  void answer(std::uint64_t client, const std::string& line);

 private:
  struct Client {
    std::uint64_t id = 0;
    int input = -1;
    int output = -1;
    std::string begun = {};     ///< of a line
    bool has_ended = false;     ///< sends no more lines
    std::uint64_t awaited = 0;  ///< answers that it has not got
    std::chrono::steady_clock::time_point next_blank = {};
    std::chrono::steady_clock::time_point last_line = {};  ///< the start, before its first
  };

  void accept_clients();
  [[nodiscard]] bool read_from(
      Client& client,
      const std::function<std::string(std::uint64_t client, std::string_view line)>& handle);
  [[nodiscard]] static bool awaits_answer(Client& client);
  static void close_client(const Client& client);

  std::string path_;
  int listener_ = -1;
  std::uint64_t next_id_ = 1;
  std::vector<Client> clients_;
  std::chrono::steady_clock::time_point next_poll_;
};

/// The path of a control socket: a name without a slash lies in $XDG_RUNTIME_DIR, which only this
/// user may enter, where that is set.
[[nodiscard]] std::string control_place(const std::string& name);

/// Throws Error if the path is too long for a socket.
[[nodiscard]] sockaddr_un control_address(const std::string& path);

}  // namespace pillarfield::cli
