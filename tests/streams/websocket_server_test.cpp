// The WebSocket server with small limits, and what clients may write to it.

#include "streams/sink/websocket_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "streams/sink/foxglove_protocol.h"

namespace pillarfield {
namespace {

/// A client that checks little.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval timeout = {20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void write(const std::string& bytes) const {
    static_cast<void>(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }

  /// Shakes hands, with an Origin unless it is empty; returns the status of the answer.
  std::string shake_hands(const std::string& origin, const std::string& host) {
    write("GET / HTTP/1.1\r\nHost: " + host +
          "\r\nUpgrade: websocket\r\nConnection: upgrade\r\n"
          "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\nSec-WebSocket-Version: 13\r\n"
          "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n" +
          (origin.empty() ? "" : "Origin: " + origin + "\r\n") + "\r\n");
    while (received_.find("\r\n\r\n") == std::string::npos && receive()) {
    }
    std::string status = received_.substr(received_.find(' ') + 1, 3);
    received_.erase(0, received_.find("\r\n\r\n") + 4);
    return status;
  }

  /// Shakes hands; returns the two messages of greeting.
  std::string greet() {
    EXPECT_EQ(shake_hands("", "127.0.0.1"), "101");
    return message().value_or("") + message().value_or("");
  }

  void write_text(const std::string& text) const {
    constexpr const char* kNoMask = "\0\0\0\0";
    write(std::string("\x81") + static_cast<char>(0x80 | text.size()) + std::string(kNoMask, 4) +
          text);
  }

  /// The content of the next message; none if the server closed.
  std::optional<std::string> message() {
    if (!need(2)) return std::nullopt;
    std::uint64_t size = static_cast<unsigned char>(received_[1]);
    const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
    if (!need(2 + more)) return std::nullopt;
    if (more > 0) size = 0;
    for (std::size_t i = 0; i < more; ++i) {
      size = size << 8 | static_cast<unsigned char>(received_[2 + i]);
    }
    if (!need(2 + more + size)) return std::nullopt;
    const std::string content = received_.substr(2 + more, size);
    const bool is_close = (received_[0] & 15) == 8;
    received_.erase(0, 2 + more + size);
    if (is_close) return std::nullopt;
    return content;
  }

  /// True if the server ends the connection, whatever it sends before.
  bool is_closed() {
    while (receive()) received_.clear();
    return !timed_out_;
  }

 private:
  bool receive() {
    std::string block(1 << 16, '\0');
    const ssize_t bytes = ::recv(socket_, block.data(), block.size(), 0);
    timed_out_ = bytes < 0 && errno == EAGAIN;
    if (bytes <= 0) return false;
    received_.append(block, 0, static_cast<std::size_t>(bytes));
    return true;
  }
  bool need(std::size_t bytes) {
    while (received_.size() < bytes) {
      if (!receive()) return false;
    }
    return true;
  }

  int socket_;
  std::string received_;
  bool timed_out_ = false;
};

class WebSocketServerTest : public ::testing::Test {
 protected:
  void serve(const ServerLimits& limits) {
    server_.emplace(address_of("127.0.0.1:0", "test", 0), "test", foxglove_protocol(), limits);
  }
  [[nodiscard]] LiveSinkStatistics statistics() const {
    LiveSinkStatistics statistics;
    server_->add_to(statistics);
    return statistics;
  }
  static void wait_until(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!condition()) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// Sends `bytes` to the subscribers of topic 0.
  void send(std::size_t bytes) {
    const auto data = std::make_shared<const std::vector<std::byte>>(bytes);
    const std::vector<ServerMessage> messages = {{0, 7, data}, {1, 7, data}};
    server_->send(messages);
  }
  void subscribe(RawClient& client) {
    client.write_text(R"({"op":"subscribe","subscriptions":[{"id":9,"channelId":0}]})");
    wait_until([&] { return server_->wanted().test(0); });
  }

  std::optional<WebSocketServer> server_;
};

TEST_F(WebSocketServerTest, LostFramesOfAClientAreCountedExactly) {
  constexpr std::size_t kBytes = 1 << 20;
  constexpr std::size_t kFrames = 40;
  serve({.queue_bytes = 3 * kBytes});
  RawClient client(server_->port());
  EXPECT_NE(client.greet().find("/skin/contacts/16"), std::string::npos);
  subscribe(client);
  for (std::size_t i = 0; i < kFrames; ++i) send(kBytes);
  const std::uint64_t lost = statistics().dropped;
  EXPECT_GT(lost, 10u);
  std::size_t received = 0;
  std::thread finisher([&] { server_->finish(); });
  while (const auto message = client.message()) {
    EXPECT_EQ(message->size(), kBytes + kMessageDataBytes);
    EXPECT_EQ(message->substr(0, 6), std::string("\x01\x09\0\0\0\x07", 6));
    ++received;
  }
  finisher.join();
  EXPECT_EQ(received + lost, kFrames);
}

TEST_F(WebSocketServerTest, OneFrameMayAlwaysWait) {
  serve({.queue_bytes = 10});
  RawClient client(server_->port());
  client.greet();
  subscribe(client);
  send(1000);
  EXPECT_EQ(client.message().value_or("").size(), 1000 + kMessageDataBytes);
  EXPECT_EQ(statistics().dropped, 0u);
}

TEST_F(WebSocketServerTest, ClientsWithoutALifeSignAreDisconnected) {
  serve({.handshake_s = 0.2, .silence_s = 0.4});
  RawClient mute(server_->port());
  RawClient deaf(server_->port());
  deaf.greet();
  EXPECT_EQ(statistics().clients, 1u);
  EXPECT_TRUE(mute.is_closed());
  EXPECT_TRUE(deaf.is_closed());  // It answers no ping.
  wait_until([&] { return statistics().clients == 0; });
  EXPECT_EQ(statistics().refused, 1u);
}

TEST_F(WebSocketServerTest, PlacesOfClientsAreFreedAgain) {
  serve({.clients = 2});
  for (int i = 0; i < 20; ++i) {
    wait_until([&] { return statistics().clients < 2; });
    RawClient client(server_->port());
    EXPECT_FALSE(client.greet().empty());
  }
  const RawClient one(server_->port());
  wait_until([&] { return statistics().clients == 0; });
  RawClient two(server_->port());
  EXPECT_FALSE(two.greet().empty());
  RawClient three(server_->port());
  EXPECT_TRUE(three.is_closed());
  EXPECT_EQ(statistics().refused, 1u);
}

TEST_F(WebSocketServerTest, WebPagesMustBeAllowed) {
  serve({.allowed_origins = {"https://app.foxglove.dev", "http://robot.example:80"}});
  const auto status = [&](const std::string& origin, const std::string& host) {
    return RawClient(server_->port()).shake_hands(origin, host);
  };
  for (const char* origin : {"", "file://", "http://localhost:3000", "https://127.0.0.1",
                             "http://[::1]:8080", "https://app.foxglove.dev"}) {
    EXPECT_EQ(status(origin, "localhost:8765"), "101") << origin;
  }
  for (const char* host : {"192.0.2.7:8765", "[2001:db8::7]:8765", "robot.example:8765"}) {
    EXPECT_EQ(status("", host), "101") << host;
  }
  EXPECT_EQ(status("http://192.0.2.7:8766", "192.0.2.7:8766"), "101");  // a page of this server
  EXPECT_EQ(statistics().notice, "");
  for (const char* origin :
       {"https://evil.example", "null", "http://localhost.evil.example",
        "https://127.0.0.1.evil.example", "https://app.foxglove.dev.evil.example",
        "http://192.0.2.7:8766", "file://x", "http://127.0.0.1:80@evil.example",
        "http://[::1]evil.example", "http://localhost:80/x", "http://localhost:", "http://[::1"}) {
    EXPECT_EQ(status(origin, "127.0.0.1:8765"), "403") << origin;
  }
  EXPECT_EQ(status("", "evil.example:8765"), "403");
  EXPECT_EQ(status("http://evil.example:8766", "evil.example:8766"), "403");
  EXPECT_EQ(statistics().refused, 14u);
  EXPECT_EQ(statistics().notice,
            "refused the web page https://evil.example; --allow-origin https://evil.example admits "
            "it");
}

TEST_F(WebSocketServerTest, ClientsThatFloodWithPingsAreDisconnected) {
  serve({.controls_per_s = 10});
  RawClient client(server_->port());
  client.greet();
  const std::string ping("\x89\x80\0\0\0\0", 6);
  for (int i = 0; i < 10; ++i) client.write(ping);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(client.message(), "");
  for (int i = 0; i < 5000; ++i) client.write(ping);
  EXPECT_TRUE(client.is_closed());
  EXPECT_EQ(statistics().refused, 1u);
}

std::string repeated(int times, const std::string& bytes) {
  std::string all;
  for (int i = 0; i < times; ++i) all += bytes;
  return all;
}

/// Clients that write these bytes after they have greeted, or instead, are disconnected, and
/// another one loses nothing.
TEST_F(WebSocketServerTest, HostileClientsAreDisconnected) {
  serve({.handshake_s = 0.5});
  RawClient honest(server_->port());
  honest.greet();
  subscribe(honest);
  const std::string no_mask(4, '\0');
  const struct {
    const char* name;
    bool greets;
    std::string bytes;
  } attacks[] = {
      {"a message of 70,000 bytes", true,
       "\x81\xff" + std::string("\0\0\0\0\0\x01\x11\x70", 8) + no_mask + std::string(70000, 'x')},
      {"many texts that are no JSON", true, repeated(40, "\x81\x81" + no_mask + "{")},
      {"many empty messages", true, repeated(40, "\x81\x80" + no_mask)},
      {"many binary messages", true, repeated(40, "\x82\x81" + no_mask + "x")},
      {"no frame", true, std::string(100, '\xff')},
      {"a frame without a mask", true, "\x81\x05hello"},
      {"a length beyond all", true, "\x81\xff" + std::string(8, '\xff') + no_mask},
      {"a text that is not UTF-8", true, "\x81\x82" + no_mask + "\xff\xfe"},
      {"a request of many lines", false, "GET / HTTP/1.1\r\n" + repeated(5000, "X: y\r\n")},
      {"a request that never ends", false, "GET / HTTP/1.1\r\n"},
      {"a request for no WebSocket", false, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"},
  };
  for (const auto& attack : attacks) {
    RawClient client(server_->port());
    if (attack.greets) client.greet();
    client.write(attack.bytes);
    EXPECT_TRUE(client.is_closed()) << attack.name;
  }
  for (int i = 0; i < 20; ++i) {  // They die amid a message.
    RawClient client(server_->port());
    client.greet();
    client.write(std::string("\x81\xfe\x10\x00mask{", 9));
  }
  for (int i = 0; i < 10; ++i) {
    send(1000);
    EXPECT_EQ(honest.message().value_or("").size(), 1000 + kMessageDataBytes);
  }
  EXPECT_EQ(statistics().dropped, 0u);
  EXPECT_GT(statistics().refused, 5u);
}

TEST_F(WebSocketServerTest, DestroyedAtAnyMoment) {
  for (int i = 0; i < 20; ++i) {
    serve({});
    RawClient client(server_->port());
    if (i % 2 == 0) {
      client.greet();
      subscribe(client);
      for (int frame = 0; frame < i; ++frame) send(1 << 20);
    }
    server_.reset();
    EXPECT_TRUE(client.is_closed());
  }
}

TEST(Subscriptions, SurviveAnyText) {
  std::mt19937 random(7);
  std::istringstream words(
      R"({ } [ ] : , "op" "subscribe" "id" 1 -1 1e9 null 0.5 "\u true "channelId" "subscriptions" )"
      R"("unsubscribe" "subscriptionIds" )"
      "\xff");
  const std::vector<std::string> pieces(std::istream_iterator<std::string>(words), {});
  Subscriptions subscriptions;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = i % 2 == 0 ? R"({"op":"subscribe","subscriptions":[{"id":)" : "";
    for (auto piece = random() % 20; piece > 0; --piece) {
      text += pieces[random() % pieces.size()];
    }
    static_cast<void>(subscriptions.obey(text));
  }
  static_cast<void>(subscriptions.obey(std::string(65536, '[')));
  EXPECT_TRUE(subscriptions.topics().none());
}

TEST(Subscriptions, ObeyInPart) {
  Subscriptions subscriptions;
  EXPECT_NE(subscriptions.obey(R"({"op":"subscribe","subscriptions":[{"id":4,"channelId":2},
      {"id":4,"channelId":3},{"id":5,"channelId":2},{"id":6,"channelId":0}]})"),
            "");
  EXPECT_EQ(subscriptions.of(2), 4u);
  EXPECT_EQ(subscriptions.of(0), 6u);
  EXPECT_EQ(subscriptions.topics().count(), 2u);
  EXPECT_EQ(subscriptions.obey(R"({"op":"unsubscribe","subscriptionIds":[4]})"), "");
  EXPECT_EQ(subscriptions.topics().count(), 1u);
}

}  // namespace
}  // namespace pillarfield
