#include "streams/sink/websocket_server.h"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstring>
#include <exception>
#include <functional>
#include <mutex>
#include <semaphore>
#include <thread>
#include <utility>

#include "base/thread_pool.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/sink/websocket_session.h"

namespace pillarfield {

namespace asio = boost::asio;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

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
  hub.session_id = std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
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
  start_session(std::move(socket), hub);
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
