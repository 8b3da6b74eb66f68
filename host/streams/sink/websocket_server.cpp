#include "streams/sink/websocket_server.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <semaphore>
#include <set>
#include <thread>
#include <utility>

#include "base/thread_pool.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/sink/web_access.h"

namespace pillarfield {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

std::chrono::milliseconds milliseconds_of(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

/// The first subprotocol of the client's list among `names`; empty if there is none.
std::string chosen_subprotocol(const http::request<http::empty_body>& request,
                               const std::vector<std::string>& names) {
  for (const auto word : http::token_list(request[http::field::sec_websocket_protocol])) {
    std::string name(word.data(), word.size());
    if (std::ranges::count(names, name) > 0) return name;
  }
  return {};
}

/// A message that waits to be sent to a client.
struct Outgoing {
  std::vector<std::byte> head;
  std::shared_ptr<const std::vector<std::byte>> data;  // null: text
  std::string text;

  [[nodiscard]] std::size_t bytes() const { return data ? data->size() : text.size(); }
};

class Session;

/// State that the sessions share; used by the server's thread alone, but for the atomic members.
struct Hub {
  ServerLimits limits;
  ServerProtocol protocol;
  std::set<std::shared_ptr<Session>> sessions = {};
  std::atomic<std::uint64_t> clients = 0;
  std::atomic<std::uint64_t> refused = 0;
  std::atomic<std::uint64_t> lost = 0;
  std::atomic<unsigned long> wanted = 0;
  mutable std::mutex mutex = {};  // guards `notice`
  std::string notice = {};        // why a client was refused; the first one

  void update_wanted();
};

/// A connection. It lives while one of its operations is pending.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, Hub& hub)
      : hub_(hub), socket_(std::move(socket)), pause_(socket_.get_executor()) {}

  void start();
  /// Queues the messages that the client wants.
  void send(std::span<const ServerMessage> messages);
  [[nodiscard]] bool is_idle() const { return queue_.empty(); }
  [[nodiscard]] TopicSet wanted() const { return protocol_->topics(); }
  /// Ends the connection in an orderly way.
  void close();

 private:
  void accept_upgrade(ErrorCode error);
  void greet(ErrorCode error);
  void read();
  void handle(ErrorCode error);
  void queue(Outgoing message);
  void write();
  void closed(ErrorCode) { end(); }
  void refuse();
  void forbid(const std::string& why);
  void count_control();
  void end();

  /// Binds a member function to a result of an operation and the life of the session.
  auto then(void (Session::*member)(ErrorCode)) {
    return [self = shared_from_this(), member](ErrorCode error, auto&&...) {
      (self.get()->*member)(error);
    };
  }
  void answer(const char* status, const char* type, std::string_view text) {
    answer_ = http_answer(status, type, text);
    asio::async_write(socket_.next_layer(), asio::buffer(answer_), then(&Session::closed));
  }

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer pause_;
  http::request<http::empty_body> request_;
  std::string answer_;
  beast::flat_buffer buffer_;
  std::unique_ptr<ClientProtocol> protocol_ = hub_.protocol.create();
  std::deque<Outgoing> queue_;  // the first is being written
  std::size_t queued_bytes_ = 0;
  std::size_t invalid_ = 0;
  std::size_t controls_ = 0;  // in the second from `controls_since_` on
  std::chrono::steady_clock::time_point controls_since_;
  bool is_client_ = false;  // after the handshake
  bool is_closing_ = false;
  bool has_ended_ = false;
};

void Hub::update_wanted() {
  TopicSet all;
  for (const auto& session : sessions) all |= session->wanted();
  wanted = all.to_ulong();
}

void Session::start() {
  constexpr std::size_t kMostHeaderBytes = 8192;
  ErrorCode ignored;
  beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true), ignored);
  beast::get_lowest_layer(socket_).expires_after(milliseconds_of(hub_.limits.handshake_s));
  buffer_.max_size(kMostHeaderBytes);
  http::async_read(socket_.next_layer(), buffer_, request_, then(&Session::accept_upgrade));
}

void Session::accept_upgrade(ErrorCode error) {
  if (error) return refuse();
  const auto text = [this](http::field field) {
    const auto value = request_[field];
    return std::string_view(value.data(), value.size());
  };
  const std::string why =
      refusal_of(text(http::field::origin), text(http::field::host), hub_.limits.allowed_origins);
  if (!why.empty()) return forbid(why);
  if (!websocket::is_upgrade(request_) && !hub_.protocol.page.empty()) {
    return request_.target() == "/" ? answer("200 OK", "text/html", hub_.protocol.page)
                                    : answer("404 Not Found", "text/plain", "The page is at /\n");
  }
  const std::string subprotocol = chosen_subprotocol(request_, hub_.protocol.names);
  if (!websocket::is_upgrade(request_) || subprotocol.empty()) return refuse();
  beast::get_lowest_layer(socket_).expires_never();  // The WebSocket has timeouts of its own.
  socket_.set_option(
      websocket::stream_base::timeout{.handshake_timeout = milliseconds_of(hub_.limits.handshake_s),
                                      .idle_timeout = milliseconds_of(hub_.limits.silence_s),
                                      .keep_alive_pings = true});
  socket_.set_option(
      websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, subprotocol);
        response.set(http::field::server, "pillarfield");
      }));
  socket_.read_message_max(hub_.limits.message_bytes);
  socket_.auto_fragment(false);
  socket_.control_callback([this](websocket::frame_type, beast::string_view) { count_control(); });
  socket_.async_accept(request_, then(&Session::greet));
}

void Session::greet(ErrorCode error) {
  if (error) return refuse();
  request_ = {};
  buffer_ = {};
  is_client_ = true;
  ++hub_.clients;
  for (const std::string& text : protocol_->greeting()) queue({{}, nullptr, text});
  read();
}

void Session::read() { socket_.async_read(buffer_, then(&Session::handle)); }

/// Handles a message of the client, which may hold anything.
void Session::handle(ErrorCode error) {
  constexpr std::chrono::microseconds kPause{1000};
  constexpr std::chrono::microseconds kPausePerByte{16};
  if (error) return error == websocket::error::message_too_big ? refuse() : end();
  const auto bytes = buffer_.cdata();
  const std::string why =
      socket_.got_text() ? protocol_->obey({static_cast<const char*>(bytes.data()), bytes.size()})
                         : "this server takes no binary messages";
  pause_.expires_after(kPause + bytes.size() * kPausePerByte);
  buffer_.consume(buffer_.size());
  hub_.update_wanted();
  if (!why.empty()) {
    if (++invalid_ > hub_.limits.invalid_messages) return refuse();
    queue({{}, nullptr, protocol_->complaint(why)});
  }
  pause_.async_wait([self = shared_from_this()](ErrorCode cancelled) {
    if (!cancelled && !self->has_ended_) self->read();
  });
}

void Session::send(std::span<const ServerMessage> messages) {
  if (!is_client_ || is_closing_) return;
  const TopicSet wanted = protocol_->topics();
  std::size_t bytes = 0;
  for (const ServerMessage& message : messages) {
    if (wanted.test(message.topic)) bytes += message.bytes->size();
  }
  if (bytes == 0) return;
  if (!queue_.empty() && queued_bytes_ + bytes > hub_.limits.queue_bytes) {
    ++hub_.lost;
    return;
  }
  for (const ServerMessage& message : messages) {
    if (!wanted.test(message.topic)) continue;
    queue({protocol_->take_head(message.topic, message.time_ns), message.bytes, {}});
  }
}

void Session::queue(Outgoing message) {
  queued_bytes_ += message.bytes();
  queue_.push_back(std::move(message));
  if (queue_.size() == 1) write();
}

void Session::write() {
  const Outgoing& message = queue_.front();
  const auto written = [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) return self->end();
    self->queued_bytes_ -= self->queue_.front().bytes();
    self->queue_.pop_front();
    if (!self->queue_.empty()) self->write();
  };
  socket_.binary(message.data != nullptr);
  if (message.data != nullptr) {
    const std::array<asio::const_buffer, 2> buffers = {
        asio::buffer(message.head.data(), message.head.size()),
        asio::buffer(message.data->data(), message.data->size())};
    socket_.async_write(buffers, written);
  } else {
    socket_.async_write(asio::buffer(message.text), written);
  }
}

void Session::close() {
  if (std::exchange(is_closing_, true)) return;
  if (!is_client_) return end();
  socket_.async_close(websocket::close_code::going_away, then(&Session::closed));
}

/// Ends the connection of a client that broke a limit.
void Session::refuse() {
  ++hub_.refused;
  end();
}

/// Counts a ping or pong; any number of them may come within one message.
void Session::count_control() {
  const auto now = std::chrono::steady_clock::now();
  if (now - controls_since_ >= std::chrono::seconds(1)) {
    controls_since_ = now;
    controls_ = 0;
  }
  // Not at once, since the caller still uses the socket.
  if (++controls_ == hub_.limits.controls_per_s + 1) {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->refuse(); });
  }
}

/// Answers a request that may not connect.
void Session::forbid(const std::string& why) {
  ++hub_.refused;
  {
    const std::scoped_lock lock(hub_.mutex);
    if (hub_.notice.empty()) hub_.notice = why;
  }
  answer("403 Forbidden", "text/plain", why + "\n");
}

void Session::end() {
  if (std::exchange(has_ended_, true)) return;
  if (is_client_) --hub_.clients;
  is_closing_ = true;
  pause_.cancel();
  beast::get_lowest_layer(socket_).close();
  hub_.sessions.erase(shared_from_this());
  hub_.update_wanted();
}

}  // namespace

struct WebSocketServer::State {
  State(const SocketAddress& address, const std::string& target, const ServerProtocol& protocol,
        const ServerLimits& limits);
  ~State();

  void serve() noexcept;
  void accept();
  void take(tcp::socket socket);
  /// Runs `action` in the server's thread, and waits for it.
  void run(const std::function<void()>& action);

  Hub hub;
  asio::io_context context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work = asio::make_work_guard(context);
  tcp::acceptor acceptor{context};
  asio::steady_timer retry{context};
  std::uint16_t port = 0;
  std::thread thread;
};

WebSocketServer::State::State(const SocketAddress& address, const std::string& target,
                              const ServerProtocol& protocol, const ServerLimits& limits)
    : hub{.limits = limits, .protocol = protocol} {
  try {
    tcp::endpoint endpoint;
    endpoint.resize(address.size);
    std::memcpy(endpoint.data(), address.get(), address.size);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(tcp::acceptor::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    port = acceptor.local_endpoint().port();
  } catch (const boost::system::system_error& error) {
    throw Error(printable(target), error.code().message(), "choose another address or port");
  }
  accept();
  thread = std::thread([this] {
    yield_to_other_threads();
    serve();
  });
}

WebSocketServer::State::~State() {
  context.stop();
  thread.join();
  hub.sessions.clear();
}

/// An exception (for example bad_alloc) ends one client's operation; its timeout then closes it.
void WebSocketServer::State::serve() noexcept {
  while (!context.stopped()) {
    try {
      context.run();
    } catch (const std::exception&) {
    }
  }
}

void WebSocketServer::State::accept() {
  acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    // Such as too many open files, which will not be over at once.
    constexpr std::chrono::milliseconds kPause{100};
    retry.expires_after(kPause);
    retry.async_wait([this](ErrorCode cancelled) {
      if (!cancelled) accept();
    });
  });
}

void WebSocketServer::State::take(tcp::socket socket) {
  if (hub.sessions.size() >= hub.limits.clients) {
    ++hub.refused;
    return;  // The destructor closes the socket.
  }
  const auto session = std::make_shared<Session>(std::move(socket), hub);
  hub.sessions.insert(session);
  session->start();
}

void WebSocketServer::State::run(const std::function<void()>& action) {
  std::binary_semaphore done(0);
  std::exception_ptr error;
  asio::post(context, [&] {
    try {
      action();
    } catch (...) {
      error = std::current_exception();
    }
    done.release();
  });
  done.acquire();
  if (error) std::rethrow_exception(error);
}

WebSocketServer::WebSocketServer(const SocketAddress& address, const std::string& target,
                                 const ServerProtocol& protocol, const ServerLimits& limits)
    : state_(std::make_unique<State>(address, target, protocol, limits)) {}

WebSocketServer::~WebSocketServer() = default;

std::uint16_t WebSocketServer::port() const { return state_->port; }

TopicSet WebSocketServer::wanted() const { return {state_->hub.wanted.load()}; }

void WebSocketServer::send(std::span<const ServerMessage> messages) {
  state_->run([&] {
    const auto sessions = state_->hub.sessions;  // send() may end one
    for (const auto& session : sessions) session->send(messages);
    state_->hub.update_wanted();
  });
}

void WebSocketServer::finish() {
  constexpr std::chrono::milliseconds kStep{5};
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  const auto wait_until_all = [&](auto condition) {
    bool holds = false;
    while (!holds && std::chrono::steady_clock::now() < deadline) {
      state_->run([&] { holds = std::ranges::all_of(state_->hub.sessions, condition); });
      if (!holds) std::this_thread::sleep_for(kStep);
    }
  };
  wait_until_all([](const auto& session) { return session->is_idle(); });
  state_->run([&] {
    state_->acceptor.close();
    const auto sessions = state_->hub.sessions;
    for (const auto& session : sessions) session->close();
  });
  wait_until_all([](const auto&) { return false; });  // gone
}

void WebSocketServer::add_to(LiveSinkStatistics& statistics) const {
  const Hub& hub = state_->hub;
  statistics.clients = hub.clients;
  statistics.refused = hub.refused;
  statistics.dropped += hub.lost;
  const std::scoped_lock lock(hub.mutex);
  statistics.notice = hub.notice;
}

}  // namespace pillarfield
