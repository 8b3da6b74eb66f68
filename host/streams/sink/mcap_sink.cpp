#include <chrono>

#include "streams/live_sink.h"
#include "streams/message/encoder.h"
#include "streams/sink/mcap_file.h"
#include "streams/sink/queued_sink.h"

namespace pillarfield {
namespace {

std::vector<McapChannel> channels() {
  std::vector<McapChannel> channels;
  for (const Topic& topic : topics()) {
    channels.push_back({topic.name, topic.schema->name, topic.schema->definition});
  }
  return channels;
}

/// Writes all topics, and flushes once a second.
class McapConsumer final : public SinkConsumer {
 public:
  McapConsumer(const std::string& path, const LiveSinkInfo& info)
      : file_(path, channels(), info.replace), encoder_(info) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame&) override {
    return {.forces = true, .all_planes = true, .contacts = true, .readings = true};
  }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    encoder_.encode(frame, TopicSet().set(), receiver_);
    idle();
    return true;
  }
  void report(const HealthReport& health) override { encoder_.encode(health, receiver_); }
  void idle() override {
    constexpr std::chrono::seconds kInterval{1};
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed_ < kInterval) return;
    file_.flush();
    flushed_ = now;
  }
  void finish() override { file_.finish(); }

 private:
  McapFile file_;
  MessageEncoder encoder_;
  MessageEncoder::Receiver receiver_ = [this](const EncodedMessage& message) {
    file_.append({static_cast<std::uint16_t>(message.topic), message.sequence,
                  static_cast<std::uint64_t>(message.stamp.count()), message.bytes});
  };
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace

/// A .mcap file of ROS 2 messages.
LiveSinkKind mcap_sink_kind() {
  return {.prefix = ".mcap",
          .form = "FILE.mcap",
          .create = [](const std::string& target,
                       const LiveSinkInfo& info) -> std::unique_ptr<LiveSink> {
            return std::make_unique<QueuedSink>(target,
                                                std::make_unique<McapConsumer>(target, info));
          }};
}

}  // namespace pillarfield
