#include <fmt/format.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>

#include "pillarfield/contact_columns.h"
#include "streams/live_sink.h"
#include "streams/message/health_json.h"
#include "streams/sink/address.h"
#include "streams/sink/frame_json.h"
#include "streams/sink/queued_sink.h"
#include "streams/sink/websocket_server.h"

namespace pillarfield {

std::string_view page_html();  // page.html, which CMake embeds

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

/// The page with the columns of its tables: head, path in the JSON of a contact, decimals.
std::string page_of(SkinLayout layout) {
  constexpr std::string_view kPlace = "/* columns */";
  std::string columns;
  for (const QuantityColumn& column : live_columns(layout)) {
    const std::string_view unit = column.unit;
    if (*column.live.path == '\0') continue;
    columns +=
        fmt::format(R"(["{}{}{}","{}",{}],)", column.live.head, unit.empty() ? "" : " ", unit,
                    column.live.path, unit.empty() || unit == "N" || unit == "s" ? 2 : 1);
  }
  std::string page(page_html());
  return page.replace(page.find(kPlace), kPlace.size(), columns);
}

ServerProtocol page_protocol(SkinLayout layout) {
  return {.names = {"pillarfield.page.v2"},
          .create = [] { return std::make_unique<PageClient>(); },
          .page = page_of(layout)};
}

/// The beginning of a picture; planes and status of `rows` x `cols` elements follow, then JSON.
struct PictureHead {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::uint32_t planes = 0;  ///< 3: shear_x, shear_y, normal; 1: normal
  float row_pitch_mm = 0;
  float col_pitch_mm = 0;
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
  void send(std::size_t topic, std::initializer_list<std::span<const std::byte>> parts) {
    const auto bytes = std::make_shared<std::vector<std::byte>>();
    for (const auto part : parts) bytes->insert(bytes->end(), part.begin(), part.end());
    const ServerMessage message = {topic, 0, bytes};
    server_->send({&message, 1});
  }

  std::unique_ptr<WebSocketServer> server_;
  Pitch pitch_mm_;
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

bool WebConsumer::consume(const SolvedFrame& frame) {
  const ForceFieldView& forces = frame.forces;
  const std::string_view json = json_.line(frame);
  if (json.empty()) return false;
  const std::uint32_t planes = forces.shear_x.empty() ? 1 : 3;
  const PictureHead head = {forces.rows, forces.cols, planes, static_cast<float>(pitch_mm_.row_mm),
                            static_cast<float>(pitch_mm_.col_mm)};
  send(kPictureTopic, {std::as_bytes(std::span(&head, 1)), std::as_bytes(forces.shear_x),
                       std::as_bytes(forces.shear_y), std::as_bytes(forces.normal),
                       std::as_bytes(forces.status), std::as_bytes(std::span(json))});
  return true;
}

void WebConsumer::report(const HealthReport& health) {
  const std::string json = health_json(health).dump();
  send(kHealthTopic, {std::as_bytes(std::span(json))});
}

std::unique_ptr<LiveSink> create_web_sink(const std::string& target, const LiveSinkInfo& info) {
  const std::string_view address = target.size() > kWebPrefix.size()
                                       ? std::string_view(target).substr(kWebPrefix.size())
                                       : "8766";
  const SocketAddress place = address_of(address, target, 0);
  auto server =
      std::make_unique<WebSocketServer>(place, target, page_protocol(info.forces.layout),
                                        ServerLimits{.allowed_origins = info.allowed_origins});
  const std::string name = "http://" + place_to_open(place, server->port()) + "/";
  return std::make_unique<QueuedSink>(name, std::make_unique<WebConsumer>(std::move(server), info));
}

}  // namespace

/// `web:[ADDRESS:]PORT`: a page that draws the newest frame in browsers.
LiveSinkKind web_sink_kind() {
  return {.prefix = kWebPrefix,
          .form = "web[:[ADDRESS:]PORT]",
          .stands_alone = true,
          .least_port = 0,
          .create = create_web_sink};
}

}  // namespace pillarfield
