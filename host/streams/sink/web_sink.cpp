#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "streams/live_sink.h"
#include "streams/message/health_json.h"
#include "streams/sink/address.h"
#include "streams/sink/frame_json.h"
#include "streams/sink/page.h"
#include "streams/sink/queued_sink.h"
#include "streams/sink/websocket_server.h"

namespace pillarfield {
namespace {

constexpr std::string_view kWebPrefix = "web:";
constexpr std::chrono::nanoseconds kShortestPictureInterval{16'000'000};

// Topics of the page; the first four bytes of a message.
constexpr std::size_t kPictureTopic = 0;
constexpr std::size_t kHealthTopic = 1;

/// A page asks for each picture, so that it never gets more than it draws.
class PageClient final : public ClientProtocol {
 public:
  [[nodiscard]] std::string obey(std::string_view text) override {
    if (text != "next") return "this server only knows next";
    wanted_.set(kPictureTopic);
    return {};
  }
  [[nodiscard]] std::string complaint(const std::string& why) const override { return why; }
  [[nodiscard]] TopicSet topics() const override { return wanted_; }
  [[nodiscard]] std::vector<std::byte> take_head(std::size_t topic, std::uint64_t) override {
    if (topic == kPictureTopic) wanted_.reset(kPictureTopic);
    std::vector<std::byte> head(sizeof(std::uint32_t));
    head[0] = static_cast<std::byte>(topic);
    return head;
  }

 private:
  TopicSet wanted_ = 1UL << kHealthTopic;
};

ServerProtocol page_protocol() {
  return {.names = {"pillarfield.page.v1"},
          .create = [](const std::string&) -> std::unique_ptr<ClientProtocol> {
            return std::make_unique<PageClient>();
          },
          .page = page_html()};
}

/// The beginning of a picture; planes and status of `rows` x `cols` elements follow, then JSON.
struct PictureHead {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::uint32_t planes = 0;  ///< 3: shear_x, shear_y, normal; 1: normal
  float pitch_mm = 0;
};

class WebConsumer final : public SinkConsumer {
 public:
  WebConsumer(std::unique_ptr<WebSocketServer> server, const LiveSinkInfo& info)
      : server_(std::move(server)), pitch_mm_(info.forces.element_pitch_mm), json_(info) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame& frame) override;
  [[nodiscard]] bool consume(const SolvedFrame& frame) override;
  void report(const HealthReport& health) override;
  void finish() override { server_->finish(); }
  void add_to(LiveSinkStatistics& statistics) const override { server_->add_to(statistics); }

 private:
  void send(std::size_t topic, std::vector<std::byte> bytes) {
    const ServerMessage message = {
        topic, 0, std::make_shared<const std::vector<std::byte>>(std::move(bytes))};
    server_->send({&message, 1});
  }

  std::unique_ptr<WebSocketServer> server_;
  double pitch_mm_;
  FrameJson json_;
  std::chrono::nanoseconds last_picture_{0};  // its arrival
};

/// Frames that no page waits for are skipped.
FrameParts WebConsumer::wants(const SolvedFrame& frame) {
  const bool is_early =
      frame.arrived.count() != 0 && frame.arrived - last_picture_ < kShortestPictureInterval;
  if (is_early || !server_->wanted().test(kPictureTopic)) return {};
  last_picture_ = frame.arrived;
  return {.forces = true, .contacts = true};
}

template <class T>
void append_bytes(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto more = std::as_bytes(values);
  bytes.insert(bytes.end(), more.begin(), more.end());
}

bool WebConsumer::consume(const SolvedFrame& frame) {
  const ForceFieldView& forces = frame.forces;
  const std::string_view json = json_.line(frame);
  if (json.empty()) return false;
  const PictureHead head = {.rows = forces.rows,
                            .cols = forces.cols,
                            .planes = forces.shear_x.empty() ? 1U : 3U,
                            .pitch_mm = static_cast<float>(pitch_mm_)};
  std::vector<std::byte> bytes;
  append_bytes(bytes, std::span(&head, 1));
  for (const auto plane : {forces.shear_x, forces.shear_y, forces.normal}) {
    append_bytes(bytes, plane);
  }
  append_bytes(bytes, forces.status);
  append_bytes(bytes, std::span<const char>(json));
  send(kPictureTopic, std::move(bytes));
  return true;
}

void WebConsumer::report(const HealthReport& health) {
  const std::string json = health_json(health).dump();
  std::vector<std::byte> bytes;
  append_bytes(bytes, std::span<const char>(json));
  send(kHealthTopic, std::move(bytes));
}

std::unique_ptr<LiveSink> create_web_sink(const std::string& target, const LiveSinkInfo& info) {
  const std::string_view address = target.size() > kWebPrefix.size()
                                       ? std::string_view(target).substr(kWebPrefix.size())
                                       : "8766";
  auto server =
      std::make_unique<WebSocketServer>(address_of(address, target, 0), target, page_protocol(),
                                        ServerLimits{.allowed_origins = info.allowed_origins});
  const std::string name =
      "http://" + host_and_port(split_address(address).host, server->port()) + "/";
  return std::make_unique<QueuedSink>(name, std::make_unique<WebConsumer>(std::move(server), info));
}

}  // namespace

/// `web:[ADDRESS:]PORT`: a page that draws the newest frame in browsers.
LiveSinkKind web_sink_kind() {
  return {.prefix = kWebPrefix,
          .form = "web[:[ADDRESS:]PORT]",
          .stands_alone = true,
          .create = create_web_sink};
}

}  // namespace pillarfield
