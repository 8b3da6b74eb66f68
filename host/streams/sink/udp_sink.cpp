#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/live_sink.h"
#include "streams/sink/address.h"
#include "streams/sink/frame_json.h"
#include "streams/sink/queued_sink.h"

namespace pillarfield {
namespace {

constexpr std::string_view kUdpPrefix = "udp:";

/// A connected socket that never blocks.
class DatagramSocket {
 public:
  DatagramSocket(const SocketAddress& address, const std::string& target)
      : descriptor_(
            ::socket(address.get()->sa_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    if (descriptor_ >= 0 && ::connect(descriptor_, address.get(), address.size) == 0) return;
    const int reason = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw Error(printable(target), std::strerror(reason), "give an address that can be reached");
  }
  ~DatagramSocket() { ::close(descriptor_); }
  DatagramSocket(const DatagramSocket&) = delete;
  DatagramSocket& operator=(const DatagramSocket&) = delete;

  /// Returns false if the datagram was not sent, or nobody received the one before.
  [[nodiscard]] bool send(std::string_view text) const {
    if (::send(descriptor_, text.data(), text.size(), 0) >= 0) return true;
    // The error belongs to the previous datagram, and kept this one from being sent.
    if (errno == ECONNREFUSED) {
      static_cast<void>(::send(descriptor_, text.data(), text.size(), 0));
    }
    return false;
  }

 private:
  int descriptor_;
};

class UdpConsumer final : public SinkConsumer {
 public:
  UdpConsumer(const std::string& target, const LiveSinkInfo& info)
      : socket_(address_of(std::string_view(target).substr(kUdpPrefix.size()), target, 1), target),
        json_(info) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame& frame) override {
    return {.forces = frame.contacts == nullptr, .contacts = true};
  }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    const std::string_view line = json_.line(frame);
    return !line.empty() && socket_.send(line);
  }

 private:
  DatagramSocket socket_;
  FrameJson json_;
};

}  // namespace

/// `udp:ADDRESS:PORT`: one datagram of JSON a frame.
LiveSinkKind udp_sink_kind() {
  return {.prefix = kUdpPrefix,
          .form = "udp:ADDRESS:PORT",
          .least_port = 1,
          .create = [](const std::string& target,
                       const LiveSinkInfo& info) -> std::unique_ptr<LiveSink> {
            return std::make_unique<QueuedSink>(target,
                                                std::make_unique<UdpConsumer>(target, info));
          }};
}

}  // namespace pillarfield
