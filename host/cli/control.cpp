// pillarfield control: one line to a stream, and its answer.

#include "cli/stream/control.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "cli/commands.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// A connection to the control socket of a stream.
class ControlClient {
 public:
  explicit ControlClient(std::string path)
      : path_(std::move(path)),
        socket_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~ControlClient() { close(socket_); }
  ControlClient(const ControlClient&) = delete;
  ControlClient& operator=(const ControlClient&) = delete;

  /// Throws Error if no stream listens there, or none accepts the connection within 5 s.
  void connect() {
    const sockaddr_un address = control_address(path_);
    const auto end = Clock::now() + std::chrono::seconds(5);
    while (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      const int failure = errno;
      if (failure == ECONNREFUSED || failure == ENOENT) {
        throw Error(path_, "no stream listens on this socket",
                    "start one with 'pillarfield stream SOURCE --control SOCKET'");
      }
      if (failure != EAGAIN && failure != EINTR) {
        throw Error(path_, std::generic_category().message(failure), "check its permissions");
      }
      stop_after(end, "the stream is busy and accepts no connection");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  /// Sends a line and returns its answer. Throws Error if none comes within 75 s; a tare takes at
  /// most 60 s.
  std::string ask(const std::string& line) {
    const std::string text = line + '\n';
    if (send(socket_, text.data(), text.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(text.size())) {
      fail("the line cannot be sent");
    }
    const auto end = Clock::now() + std::chrono::seconds(75);
    std::string answer;
    while (!answer.ends_with('\n')) {
      stop_after(end, "the stream does not answer");
      pollfd ready = {.fd = socket_, .events = POLLIN, .revents = 0};
      if (poll(&ready, 1, 100) != 1) continue;
      std::array<char, 4096> bytes{};
      const ssize_t count = read(socket_, bytes.data(), bytes.size());
      if (count > 0) answer.append(bytes.data(), static_cast<std::size_t>(count));
      if (count == 0) fail("the stream ended the connection without an answer");
    }
    return answer;
  }

 private:
  [[noreturn]] void fail(const char* failure) const {
    throw Error(path_, failure, "it may have ended or have too many clients; try again");
  }
  void stop_after(Clock::time_point end, const char* failure) const {
    if (is_interrupted()) throw Error(path_, "interrupted before an answer came", "ask again");
    if (Clock::now() > end) fail(failure);
  }

  std::string path_;
  int socket_;
};

/// The line of the words; a file to record is that of this folder, not of the stream's.
std::string line_of(std::vector<std::string> words) {
  if (words.size() == 2 && words[0] == "record" && words[1] != "stop") {
    words[1] = std::filesystem::absolute(words[1]).string();
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

void control(const ControlOptions& options) {
  ControlClient client(control_place(options.socket));
  client.connect();
  const std::string answer = client.ask(line_of(options.words));
  const auto json = nlohmann::ordered_json::parse(answer, nullptr, false);
  if (!json.is_object() || !json.contains("ok")) {
    throw Error(options.socket, "the answer is not that of a stream",
                "name the socket of 'pillarfield stream --control'");
  }
  fmt::print("{}\n", json.dump());
  if (json["ok"] == true) return;
  throw Error(options.socket, json.value("error", "refused"));
}

}  // namespace pillarfield::cli
