#include "streams/sink/foxglove_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace pillarfield {
namespace {

using Json = nlohmann::ordered_json;

/// A member that is a whole number of 32 bits.
std::optional<std::uint32_t> number_in(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> number_in(const Json& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) return std::nullopt;
  return number_in(object[name]);
}

/// The list of this name; null if there is none.
const Json* list_in(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_array() ? &*found : nullptr;
}

std::string server_info_json(const std::string& session) {
  return Json({{"op", "serverInfo"},
               {"name", "pillarfield"},
               {"capabilities", Json::array()},
               {"sessionId", session}})
      .dump();
}

std::string advertise_json() {
  Json channels = Json::array();
  for (const Topic& topic : topics()) {
    channels.push_back({{"id", channels.size()},
                        {"topic", topic.name},
                        {"encoding", "cdr"},
                        {"schemaName", topic.schema->name},
                        {"schemaEncoding", "ros2msg"},
                        {"schema", topic.schema->definition}});
  }
  return Json({{"op", "advertise"}, {"channels", channels}}).dump();
}

class FoxgloveClient final : public ClientProtocol {
 public:
  explicit FoxgloveClient(std::string session) : session_(std::move(session)) {}

  [[nodiscard]] std::vector<std::string> greeting() const override {
    return {server_info_json(session_), advertise_json()};
  }
  [[nodiscard]] std::string obey(std::string_view text) override {
    return subscriptions_.obey(text);
  }
  [[nodiscard]] std::string complaint(const std::string& why) const override {
    constexpr int kError = 2;
    return Json({{"op", "status"}, {"level", kError}, {"message", why}}).dump();
  }
  [[nodiscard]] TopicSet topics() const override { return subscriptions_.topics(); }
  [[nodiscard]] std::vector<std::byte> take_head(std::size_t topic,
                                                 std::uint64_t time_ns) override {
    static_assert(std::endian::native == std::endian::little);
    const std::uint32_t subscription = subscriptions_.of(topic).value();
    std::vector<std::byte> head(kMessageDataBytes);
    head[0] = std::byte{1};  // the operation
    std::memcpy(&head[1], &subscription, sizeof subscription);
    std::memcpy(&head[5], &time_ns, sizeof time_ns);
    return head;
  }

 private:
  std::string session_;
  Subscriptions subscriptions_;
};

}  // namespace

ServerProtocol foxglove_protocol() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return {.names = {"foxglove.sdk.v1", "foxglove.websocket.v1"},
          .create = [session = std::to_string(now.count())] {
            return std::make_unique<FoxgloveClient>(session);
          }};
}

std::string Subscriptions::obey(std::string_view text) {
  const Json message = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object() || !message.contains("op") || !message["op"].is_string()) {
    return "a message is a JSON object with an op";
  }
  const auto op = message["op"].get<std::string>();
  std::string error;
  if (op == "subscribe") {
    const Json* const list = list_in(message, "subscriptions");
    if (list == nullptr) return "subscriptions is not a list";
    for (const Json& each : *list) {
      const auto id = number_in(each, "id");
      const auto topic = number_in(each, "channelId");
      if (!id || !topic) return "id and channelId are whole numbers";
      if (const std::string why = subscribe(*id, *topic); !why.empty()) error = why;
    }
    return error;
  }
  if (op == "unsubscribe") {
    const Json* const list = list_in(message, "subscriptionIds");
    if (list == nullptr) return "subscriptionIds is not a list";
    for (const Json& each : *list) {
      const auto id = number_in(each);
      if (!id) return "a subscription is a whole number";
      if (const std::string why = unsubscribe(*id); !why.empty()) error = why;
    }
    return error;
  }
  return "this server only knows subscribe and unsubscribe";
}

std::string Subscriptions::subscribe(std::uint32_t id, std::uint32_t topic) {
  if (topic >= kTopics) return fmt::format("there is no channel {}", topic);
  if (ids_[topic]) return fmt::format("channel {} is subscribed already", topic);
  if (std::ranges::count(ids_, std::optional(id)) > 0) {
    return fmt::format("subscription {} exists already", id);
  }
  ids_[topic] = id;
  return {};
}

std::string Subscriptions::unsubscribe(std::uint32_t id) {
  auto* const found = std::ranges::find(ids_, std::optional(id));
  if (found == ids_.end()) return fmt::format("there is no subscription {}", id);
  found->reset();
  return {};
}

TopicSet Subscriptions::topics() const {
  TopicSet set;
  for (std::size_t topic = 0; topic < kTopics; ++topic) set[topic] = ids_[topic].has_value();
  return set;
}

}  // namespace pillarfield
