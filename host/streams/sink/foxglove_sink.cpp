#include <memory>
#include <utility>

#include "streams/live_sink.h"
#include "streams/message/encoder.h"
#include "streams/sink/address.h"
#include "streams/sink/foxglove_protocol.h"
#include "streams/sink/queued_sink.h"
#include "streams/sink/websocket_server.h"

namespace pillarfield {
namespace {

constexpr std::string_view kFoxglovePrefix = "foxglove:";
constexpr std::chrono::nanoseconds kPictureInterval{16'000'000};

/// Sends what clients subscribe to: contacts and time of each frame, images, points, fields and
/// arrows at most about 60 times a second.
class FoxgloveConsumer final : public SinkConsumer {
 public:
  FoxgloveConsumer(std::unique_ptr<WebSocketServer> server, const LiveSinkInfo& info)
      : server_(std::move(server)), encoder_(info) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame& frame) override;
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    encoder_.encode(frame, server_->wanted(), receiver_);
    send();
    return true;
  }
  void report(const HealthReport& health) override {
    if (!server_->wanted().test(topic::kHealth)) return;
    encoder_.encode(health, receiver_);
    send();
  }
  void finish() override { server_->finish(); }
  void add_to(LiveSinkStatistics& statistics) const override { server_->add_to(statistics); }

 private:
  void send() {
    if (!messages_.empty()) server_->send(messages_);
    messages_.clear();
  }

  std::unique_ptr<WebSocketServer> server_;
  MessageEncoder encoder_;
  std::chrono::nanoseconds last_picture_{0};  // its arrival
  std::vector<ServerMessage> messages_;       // of the frame
  MessageEncoder::Receiver receiver_ = [this](const EncodedMessage& message) {
    messages_.push_back({message.topic, static_cast<std::uint64_t>(message.stamp.count()),
                         std::make_shared<const std::vector<std::byte>>(message.bytes.begin(),
                                                                        message.bytes.end())});
  };
};

FrameParts FoxgloveConsumer::wants(const SolvedFrame& frame) {
  const TopicSet wanted = server_->wanted();
  FrameParts parts;
  // Contacts come with the time, too, since a frame without parts is skipped.
  parts.contacts =
      (wanted & contact_topics()).any() || wanted[topic::kArrows] || wanted[topic::kTime];
  const bool has_arrival = frame.arrived.count() != 0;
  if (has_arrival && frame.arrived - last_picture_ < kPictureInterval) return parts;
  parts.all_planes = wanted[topic::kField];
  parts.forces = wanted[topic::kNormal] || wanted[topic::kForces] || parts.all_planes;
  parts.readings = wanted[topic::kRaw];
  if (parts.forces || parts.readings) last_picture_ = frame.arrived;
  return parts;
}

std::unique_ptr<LiveSink> create_foxglove_sink(const std::string& target,
                                               const LiveSinkInfo& info) {
  const std::string_view address = target.size() > kFoxglovePrefix.size()
                                       ? std::string_view(target).substr(kFoxglovePrefix.size())
                                       : "8765";
  const SocketAddress place = address_of(address, target, 0);
  auto server = std::make_unique<WebSocketServer>(
      place, target, foxglove_protocol(), ServerLimits{.allowed_origins = info.allowed_origins});
  const std::string name = std::string(kFoxglovePrefix) + place_to_open(place, server->port());
  return std::make_unique<QueuedSink>(name,
                                      std::make_unique<FoxgloveConsumer>(std::move(server), info));
}

}  // namespace

/// `foxglove:[ADDRESS:]PORT`: a WebSocket server of ROS 2 messages.
LiveSinkKind foxglove_sink_kind() {
  return {.prefix = kFoxglovePrefix,
          .form = "foxglove[:[ADDRESS:]PORT]",
          .stands_alone = true,
          .least_port = 0,
          .create = create_foxglove_sink};
}

}  // namespace pillarfield
