#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/live_sink.h"
#include "streams/message/host_clock.h"
#include "streams/message/topics.h"
#include "streams/sink/address.h"
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

/// The members of a contact or of the total.
void append_quantities(fmt::memory_buffer& json, const ContactQuantities& contact) {
  const auto out = std::back_inserter(json);
  if (contact.has_shear) {
    fmt::format_to(out, R"("force":{{"shear_x":{},"shear_y":{},"normal":{}}},"torque_nmm":{},)",
                   contact.shear_x_n, contact.shear_y_n, contact.normal_n, contact.torque_nmm);
  } else {
    fmt::format_to(out, R"("force":{{"normal":{}}},"peak_pressure_kpa":{},)", contact.normal_n,
                   contact.peak_pressure_kpa());
  }
  fmt::format_to(out, R"("{}":{},"centre_mm":{{"x":{},"y":{}}})",
                 contact.has_shear ? "pillars" : "sensels", contact.pillars,
                 contact.centre_of_pressure.x_mm, contact.centre_of_pressure.y_mm);
  if (contact.friction) {
    fmt::format_to(std::back_inserter(json), R"(,"friction":{})", *contact.friction);
  }
  if (contact.slip_margin) {
    fmt::format_to(std::back_inserter(json), R"(,"slip_margin":{})", *contact.slip_margin);
  }
  if (contact.slip_forecast && contact.slip_forecast->time_s) {
    fmt::format_to(std::back_inserter(json), R"(,"time_to_slip_s":{})",
                   *contact.slip_forecast->time_s);
  }
}

class UdpConsumer final : public SinkConsumer {
 public:
  UdpConsumer(const std::string& target, const LiveSinkInfo& info)
      : socket_(address_of(std::string_view(target).substr(kUdpPrefix.size()), target, 1), target) {
    ContactOptions options;
    options.layout = info.forces.layout;
    if (!info.forces.contacts) tracker_.emplace(info.forces.element_pitch_mm, options);
  }

  [[nodiscard]] FrameParts wants(const SolvedFrame& frame) override {
    return {.forces = frame.contacts == nullptr, .contacts = true};
  }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override;

 private:
  DatagramSocket socket_;
  std::optional<ContactTracker> tracker_;  // if frames come without contacts
  ContactSlots slots_;
  HostClock clock_;
  fmt::memory_buffer json_;
};

bool UdpConsumer::consume(const SolvedFrame& frame) {
  if (frame.contacts == nullptr && !tracker_) return false;
  const FrameContacts& contacts =
      frame.contacts != nullptr ? *frame.contacts : tracker_->update(frame.forces, frame.time_s);
  const double stamp_s = std::chrono::duration<double>(clock_.real_time(frame.arrived)).count();
  json_.clear();
  fmt::format_to(std::back_inserter(json_),
                 R"({{"timestamp":{:.9f},"time":{},"sequence":{},"total":{{)", stamp_s,
                 frame.time_s, frame.sequence);
  append_quantities(json_, contacts.total);
  json_.append(std::string_view(R"(},"contacts":{)"));
  std::size_t listed = 0;
  const auto& slots = slots_.update(contacts);
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (slots[slot].contact == nullptr) continue;
    fmt::format_to(std::back_inserter(json_), R"({}"{}":{{"id":{},)", listed++ > 0 ? "," : "",
                   slot + 1, slots[slot].contact->track_id);
    append_quantities(json_, slots[slot].contact->quantities);
    json_.push_back('}');
  }
  fmt::format_to(std::back_inserter(json_), R"(}},"contacts_omitted":{}}})",
                 contacts.contacts.size() - listed);
  return socket_.send({json_.data(), json_.size()});
}

}  // namespace

/// `udp:ADDRESS:PORT`: one datagram of JSON a frame.
LiveSinkKind udp_sink_kind() {
  return {.prefix = kUdpPrefix,
          .form = "udp:ADDRESS:PORT",
          .create = [](const std::string& target,
                       const LiveSinkInfo& info) -> std::unique_ptr<LiveSink> {
            return std::make_unique<QueuedSink>(target,
                                                std::make_unique<UdpConsumer>(target, info));
          }};
}

}  // namespace pillarfield
