#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/live_source.h"
#include "streams/sink/address.h"
#include "streams/source/byte_source.h"

namespace pillarfield {
namespace {

constexpr std::size_t kDatagrams = 32;  ///< read at a time
constexpr std::size_t kDatagramBytes = 1 << 16;
constexpr int kReceiveBuffer = 8 << 20;  ///< bytes; the kernel may allow less

/// Packets in datagrams, one each.
class UdpSource final : public PacketSource {
 public:
  explicit UdpSource(int socket);
  ~UdpSource() override { close(socket_); }
  UdpSource(const UdpSource&) = delete;
  UdpSource& operator=(const UdpSource&) = delete;

  [[nodiscard]] Arrival receive(Packet& packet, std::chrono::nanoseconds timeout) override;
  [[nodiscard]] bool is_open_to_all() const override { return true; }
  [[nodiscard]] Counts counts() const override { return counts_; }
  [[nodiscard]] std::string complaint() const override {
    constexpr std::uint64_t kMany = 10;
    if (counts_.invalid < kMany) return {};
    return fmt::format("{} datagrams came, no packet", counts_.invalid);
  }

 private:
  using Control = std::array<std::byte, CMSG_SPACE(sizeof(std::uint32_t))>;

  [[nodiscard]] std::byte* datagram(std::size_t i) { return &memory_[i * kDatagramBytes]; }
  bool receive_batch();
  bool take(std::size_t i, Packet& packet);
  void count_drops(msghdr& message);

  int socket_;
  std::vector<std::byte> memory_;
  std::array<iovec, kDatagrams> places_ = {};
  std::array<mmsghdr, kDatagrams> messages_ = {};
  alignas(cmsghdr) std::array<Control, kDatagrams> controls_ = {};
  std::size_t next_ = 0;
  std::size_t received_ = 0;
  std::chrono::nanoseconds arrived_{0};
  Counts counts_;
  std::uint32_t drops_ = 0;  ///< of the socket, as the kernel counts them
};

UdpSource::UdpSource(int socket) : socket_(socket), memory_(kDatagrams * kDatagramBytes) {
  for (std::size_t i = 0; i < kDatagrams; ++i) {
    places_[i] = {datagram(i), kDatagramBytes};
    messages_[i].msg_hdr.msg_iov = &places_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
    messages_[i].msg_hdr.msg_control = controls_[i].data();
  }
}

Arrival UdpSource::receive(Packet& packet, std::chrono::nanoseconds timeout) {
  constexpr int kMostBatches = 4;  // of datagrams that are not packets
  for (int batches = 0; batches < kMostBatches; ++batches) {
    while (next_ < received_) {
      if (take(next_++, packet)) return Arrival::arrived;
    }
    if (receive_batch()) continue;
    if (timeout.count() <= 0 || !wait_readable(socket_, timeout)) return Arrival::timed_out;
    timeout = std::chrono::nanoseconds(0);
  }
  return Arrival::timed_out;
}

bool UdpSource::receive_batch() {
  for (mmsghdr& message : messages_) message.msg_hdr.msg_controllen = sizeof(Control);
  const int count = recvmmsg(socket_, messages_.data(), kDatagrams, MSG_DONTWAIT, nullptr);
  if (count <= 0) return false;
  arrived_ = steady_now();
  next_ = 0;
  received_ = static_cast<std::size_t>(count);
  return true;
}

/// Takes the packet of a datagram; false if it is none.
bool UdpSource::take(std::size_t i, Packet& packet) {
  count_drops(messages_[i].msg_hdr);
  if (messages_[i].msg_len < sizeof packet.header) {
    ++counts_.invalid;
    return false;
  }
  std::memcpy(&packet.header, datagram(i), sizeof packet.header);
  packet.bytes = {datagram(i) + sizeof packet.header, messages_[i].msg_len - sizeof packet.header};
  packet.arrived = arrived_;
  return true;
}

/// The kernel tells of drops with the next datagram.
void UdpSource::count_drops(msghdr& message) {
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t drops = 0;
    std::memcpy(&drops, CMSG_DATA(each), sizeof drops);
    counts_.overrun += drops - std::exchange(drops_, drops);
  }
}

std::unique_ptr<FrameStream> open_udp(const std::string& rest, const LiveSourceOptions& options) {
  const std::string name = printable("udp:" + rest);
  const SocketAddress address = address_of(rest, name, 1);
  const int opened = socket(address.get()->sa_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (opened < 0) {
    throw Error(name, std::strerror(errno), "check the network");
  }
  auto source = std::make_unique<UdpSource>(opened);
  constexpr int kOn = 1;
  setsockopt(opened, SOL_SOCKET, SO_RXQ_OVFL, &kOn, sizeof kOn);
  // The first needs a privilege, and the second is limited by net.core.rmem_max.
  if (setsockopt(opened, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBuffer, sizeof kReceiveBuffer) != 0) {
    setsockopt(opened, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
  }
  if (bind(opened, address.get(), address.size) != 0) {
    if (errno == EADDRINUSE) {
      throw Error(
          name, "another program receives there",
          "let that be stream with --relay shm:NAME and open shm:NAME, or give another port");
    }
    throw Error(name, fmt::format("cannot be bound: {}", std::strerror(errno)),
                "give an address of this computer and a free port");
  }
  return open_packet_stream(name, std::move(source), PacketOrder::not_kept, options);
}

}  // namespace

LiveSourceKind udp_kind() { return {"udp:", "udp:ADDRESS:PORT", open_udp}; }

}  // namespace pillarfield
