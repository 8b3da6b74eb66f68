#include "cli/stream/control.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

constexpr std::size_t kMostClients = 8;
constexpr std::size_t kMostLineBytes = 4096;

std::string reason() { return std::generic_category().message(errno); }

/// The errno of connecting to a socket without waiting; 0 where a program accepts connections.
int connection_failure(const sockaddr_un& address) {
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const bool is_connected =
      connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int failure = is_connected ? 0 : errno;
  close(probe);
  return failure;
}

/// Removes the socket of a program that was killed, which refuses connections; any other stays.
void remove_left_socket(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) {
    throw Error(path, "it exists and is not a socket", "name another control socket");
  }
  const int failure = connection_failure(address);
  if (failure == ECONNREFUSED) unlink(path.c_str());
  if (failure == ECONNREFUSED || failure == ENOENT) return;
  const bool is_used = failure == 0 || failure == EAGAIN;  // EAGAIN: too busy to accept
  throw Error(path,
              is_used
                  ? "another program listens on this socket"
                  : fmt::format("cannot be tried: {}", std::generic_category().message(failure)),
              "name another control socket");
}

int listen_on(const std::string& path) {
  const sockaddr_un address = control_address(path);
  remove_left_socket(path, address);
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const mode_t mask = umask(S_IRWXG | S_IRWXO);
  const bool bound =
      bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      listen(listener, static_cast<int>(kMostClients)) == 0;
  const std::string why = bound ? "" : reason();
  umask(mask);
  if (bound) return listener;
  close(listener);
  throw Error(path, fmt::format("the control socket cannot be made: {}", why),
              "name a place in a folder of yours");
}

}  // namespace

ControlChannel::ControlChannel(const std::string& path) : path_(control_place(path)) {
  if (path_.empty()) return;
  if (path == "-") {
    clients_.push_back({.id = next_id_++, .input = STDIN_FILENO, .output = STDOUT_FILENO});
    return;
  }
  listener_ = listen_on(path_);
}

ControlChannel::~ControlChannel() {
  for (const Client& client : clients_) close_client(client);
  if (listener_ < 0) return;
  close(listener_);
  unlink(path_.c_str());
}

void ControlChannel::close_client(const Client& client) {
  if (client.input != STDIN_FILENO) close(client.input);
}

void ControlChannel::poll(
    const std::function<std::string(std::uint64_t client, std::string_view line)>& handle) {
  const auto now = std::chrono::steady_clock::now();
  if (path_.empty() || now < next_poll_) return;
  next_poll_ = now + std::chrono::milliseconds(20);
  accept_clients();
  std::erase_if(clients_, [&](Client& client) {
    if (client.has_ended ? awaits_answer(client) : read_from(client, handle)) return false;
    close_client(client);
    return true;
  });
}

void ControlChannel::accept_clients() {
  if (listener_ < 0) return;
  for (;;) {
    const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (connection < 0) return;
    if (clients_.size() >= kMostClients) {  // The idle one that is silent for longest gives way.
      const auto idle = std::ranges::min_element(clients_, {}, [](const Client& client) {
        return std::pair(client.awaited > 0, client.last_line);
      });
      if (idle->awaited > 0) {
        close(connection);
        continue;
      }
      close_client(*idle);
      clients_.erase(idle);
    }
    clients_.push_back({.id = next_id_++,
                        .input = connection,
                        .output = connection,
                        .last_line = std::chrono::steady_clock::now()});
  }
}

/// Returns whether the client is still there.
bool ControlChannel::read_from(
    Client& client,
    const std::function<std::string(std::uint64_t client, std::string_view line)>& handle) {
  pollfd ready = {.fd = client.input, .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, 0) != 1) return true;
  std::array<char, kMostLineBytes> bytes{};
  const ssize_t count = read(client.input, bytes.data(), bytes.size());
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  if (count == 0) {
    client.has_ended = true;
    return awaits_answer(client);
  }
  client.begun.append(bytes.data(), static_cast<std::size_t>(count));
  for (std::size_t end = client.begun.find('\n'); end != std::string::npos;
       end = client.begun.find('\n')) {
    std::string line = client.begun.substr(0, end);
    client.begun.erase(0, end + 1);
    if (line.ends_with('\r')) line.pop_back();
    ++client.awaited;
    client.last_line = std::chrono::steady_clock::now();
    if (const std::string said = handle(client.id, line); !said.empty()) answer(client.id, said);
  }
  return client.begun.size() <= kMostLineBytes;
}

/// True if a client that has sent its last line still waits for an answer. socat leaves half a
/// second after its last line or byte from here, so blanks precede an answer that takes longer.
bool ControlChannel::awaits_answer(Client& client) {
  if (client.awaited == 0) return false;
  if (client.output == STDOUT_FILENO) return true;
  pollfd state = {.fd = client.output, .events = 0, .revents = 0};
  if (::poll(&state, 1, 0) == 1 && (state.revents & (POLLHUP | POLLERR)) != 0) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now >= client.next_blank) {
    client.next_blank = now + std::chrono::milliseconds(200);
    static_cast<void>(send(client.output, " ", 1, MSG_NOSIGNAL | MSG_DONTWAIT));
  }
  return true;
}

void ControlChannel::answer(std::uint64_t client, const std::string& line) {
  const auto found = std::ranges::find(clients_, client, &Client::id);
  if (found == clients_.end()) return;
  --found->awaited;
  const std::string text = line + '\n';
  if (found->output == STDOUT_FILENO) {
    fmt::print("{}", text);
    std::fflush(stdout);
  } else {
    // A client that does not read loses answers.
    static_cast<void>(send(found->output, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
  }
}

std::string control_place(const std::string& name) {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  const bool has_folder = folder != nullptr && folder[0] == '/';
  if (!has_folder || name.empty() || name.find('/') != std::string::npos) return name;
  return fmt::format("{}/{}", folder, name);
}

sockaddr_un control_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw Error(path, "the name of the control socket is too long",
                fmt::format("give at most {} bytes", sizeof address.sun_path - 1));
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

}  // namespace pillarfield::cli
