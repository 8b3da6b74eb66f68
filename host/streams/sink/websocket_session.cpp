#include "streams/sink/websocket_session.h"

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <utility>

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

/// What a client waits for.
struct Outgoing {
  std::vector<std::byte> head;
  std::shared_ptr<const std::vector<std::byte>> data;  // null: text
  std::string text;

  [[nodiscard]] std::size_t bytes() const { return data ? data->size() : text.size(); }
};

/// A connection. It lives while one of its operations is pending.
class WebSocketSession final : public Session,
                               public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(tcp::socket socket, Hub& hub)
      : hub_(hub),
        socket_(std::move(socket)),
        pause_(socket_.get_executor()),
        protocol_(hub.protocol.create(hub.session_id)) {}

  void start();
  void send(std::span<const ServerMessage> messages) override;
  [[nodiscard]] bool is_idle() const override { return queue_.empty(); }
  [[nodiscard]] TopicSet wanted() const override { return protocol_->topics(); }
  void close() override;

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
  void show_page();
  void answer(http::status status, const char* type, std::string_view text);
  void count_control();
  void end();

  /// Binds a member function to a result of an operation and the life of the session.
  auto then(void (WebSocketSession::*member)(ErrorCode)) {
    return [self = shared_from_this(), member](ErrorCode error, auto&&...) {
      (self.get()->*member)(error);
    };
  }

  static constexpr std::size_t kMostHeaderBytes = 8192;

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer pause_;
  http::request<http::empty_body> request_;
  http::response<http::string_body> answer_;
  beast::flat_buffer buffer_;
  std::unique_ptr<ClientProtocol> protocol_;
  std::deque<Outgoing> queue_;  // the first is being written
  std::size_t queued_bytes_ = 0;
  std::size_t invalid_ = 0;
  std::size_t controls_ = 0;  // in the second from `controls_since_` on
  std::chrono::steady_clock::time_point controls_since_;
  bool is_client_ = false;  // after the handshake
  bool is_closing_ = false;
  bool has_ended_ = false;
};

void WebSocketSession::start() {
  ErrorCode ignored;
  beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true), ignored);
  beast::get_lowest_layer(socket_).expires_after(milliseconds_of(hub_.limits.handshake_s));
  buffer_.max_size(kMostHeaderBytes);
  http::async_read(socket_.next_layer(), buffer_, request_,
                   then(&WebSocketSession::accept_upgrade));
}

void WebSocketSession::accept_upgrade(ErrorCode error) {
  if (error) return refuse();
  const auto text = [this](http::field field) {
    const auto value = request_[field];
    return std::string_view(value.data(), value.size());
  };
  const std::string why =
      refusal_of(text(http::field::origin), text(http::field::host), hub_.limits.allowed_origins);
  if (!why.empty()) return forbid(why);
  if (!websocket::is_upgrade(request_) && !hub_.protocol.page.empty()) return show_page();
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
  socket_.async_accept(request_, then(&WebSocketSession::greet));
}

void WebSocketSession::greet(ErrorCode error) {
  if (error) return refuse();
  request_ = {};
  buffer_ = {};
  is_client_ = true;
  ++hub_.clients;
  for (const std::string& text : protocol_->greeting()) queue({{}, nullptr, text});
  read();
}

void WebSocketSession::read() { socket_.async_read(buffer_, then(&WebSocketSession::handle)); }

/// Handles a message of the client, which may hold anything.
void WebSocketSession::handle(ErrorCode error) {
  constexpr std::chrono::microseconds kPause{1000};
  constexpr std::chrono::microseconds kPausePerByte{16};
  if (error) {
    const bool is_excess = error == websocket::error::message_too_big;
    return is_excess ? refuse() : end();
  }
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

void WebSocketSession::send(std::span<const ServerMessage> messages) {
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

void WebSocketSession::queue(Outgoing message) {
  queued_bytes_ += message.bytes();
  queue_.push_back(std::move(message));
  if (queue_.size() == 1) write();
}

void WebSocketSession::write() {
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

void WebSocketSession::close() {
  if (std::exchange(is_closing_, true)) return;
  if (!is_client_) return end();
  socket_.async_close(websocket::close_code::going_away, then(&WebSocketSession::closed));
}

/// Ends the connection of a client that broke a limit.
void WebSocketSession::refuse() {
  ++hub_.refused;
  end();
}

/// Counts a ping or pong, of which a flood of any length comes within one message.
void WebSocketSession::count_control() {
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
void WebSocketSession::forbid(const std::string& why) {
  ++hub_.refused;
  {
    const std::scoped_lock lock(hub_.mutex);
    if (hub_.notice.empty()) hub_.notice = why;
  }
  answer(http::status::forbidden, "text/plain", why + "\n");
}

/// Answers a browser that opens an address of this server.
void WebSocketSession::show_page() {
  if (request_.method() == http::verb::get && request_.target() == "/") {
    return answer(http::status::ok, "text/html", hub_.protocol.page);
  }
  answer(http::status::not_found, "text/plain", "The page is at /\n");
}

/// Answers a request that is none of a WebSocket. The page may load nothing, and nobody may frame
/// it.
void WebSocketSession::answer(http::status status, const char* type, std::string_view text) {
  answer_ = {status, request_.version(), std::string(text)};
  answer_.set(http::field::content_type, std::string(type) + "; charset=utf-8");
  answer_.set("Content-Security-Policy",
              "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
              "img-src data:; connect-src 'self'; frame-ancestors 'none'");
  answer_.set(http::field::cache_control, "no-store");
  answer_.keep_alive(false);
  answer_.prepare_payload();
  http::async_write(socket_.next_layer(), answer_, then(&WebSocketSession::closed));
}

void WebSocketSession::end() {
  if (std::exchange(has_ended_, true)) return;
  if (is_client_) --hub_.clients;
  is_closing_ = true;
  pause_.cancel();
  beast::get_lowest_layer(socket_).close();
  hub_.sessions.erase(shared_from_this());
  hub_.update_wanted();
}

}  // namespace

void Hub::update_wanted() {
  TopicSet all;
  for (const auto& session : sessions) all |= session->wanted();
  wanted = all.to_ulong();
}

void start_session(tcp::socket socket, Hub& hub) {
  const auto session = std::make_shared<WebSocketSession>(std::move(socket), hub);
  hub.sessions.insert(session);
  session->start();
}

}  // namespace pillarfield
