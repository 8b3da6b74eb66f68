#include "streams/sink/foxglove_protocol.h"

#include <fmt/format.h>
#include <strings.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/asio/ip/address.hpp>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

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

}  // namespace

bool is_foxglove_subprotocol(std::string_view name) {
  return name == "foxglove.sdk.v1" || name == "foxglove.websocket.v1";
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

std::string status_json(int level, const std::string& message) {
  return Json({{"op", "status"}, {"level", level}, {"message", message}}).dump();
}

std::array<std::byte, kMessageDataBytes> message_data_head(std::uint32_t subscription,
                                                           std::uint64_t time_ns) {
  static_assert(std::endian::native == std::endian::little);
  std::array<std::byte, kMessageDataBytes> head = {std::byte{1}};  // the operation
  std::memcpy(&head[1], &subscription, sizeof subscription);
  std::memcpy(&head[5], &time_ns, sizeof time_ns);
  return head;
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

namespace {

bool same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && strncasecmp(a.data(), b.data(), a.size()) == 0;
}

/// "NAME" of "NAME:PORT", "[ADDRESS]:PORT" and "NAME".
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.find(':'));
}

/// What follows "http://" or "https://"; none for another origin.
std::optional<std::string_view> host_of_page(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (same_name(origin.substr(0, scheme.size()), scheme)) return origin.substr(scheme.size());
  }
  return std::nullopt;
}

std::optional<boost::asio::ip::address> address_in(std::string_view host) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(std::string(without_port(host)), error);
  if (error) return std::nullopt;
  return address;
}

bool is_loopback(std::string_view host) {
  const auto address = address_in(host);
  return same_name(without_port(host), "localhost") || (address && address->is_loopback());
}

bool is_name_of_this_computer(std::string_view host) {
  std::array<char, 256> name = {};
  if (gethostname(name.data(), name.size() - 1) != 0) return false;
  return same_name(host, name.data()) || same_name(host, std::string(name.data()) + ".local");
}

bool may_ask(std::string_view origin, std::span<const std::string> allowed) {
  if (origin.empty() || origin == "file://") return true;
  const auto page = host_of_page(origin);
  return (page && is_loopback(*page)) || std::ranges::any_of(allowed, [&](const std::string& each) {
           return same_name(each, origin);
         });
}

bool may_be_asked(std::string_view host, std::span<const std::string> allowed) {
  if (address_in(host) || is_loopback(host) || is_name_of_this_computer(without_port(host))) {
    return true;
  }
  return std::ranges::any_of(allowed, [&](const std::string& each) {
    const auto page = host_of_page(each);
    return page && same_name(without_port(*page), without_port(host));
  });
}

}  // namespace

std::string refusal_of(std::string_view origin, std::string_view host,
                       std::span<const std::string> allowed) {
  constexpr std::size_t kMostShown = 200;
  if (!may_ask(origin, allowed)) {
    return fmt::format("refused the web page {0}; --allow-origin {0} admits it",
                       origin.substr(0, kMostShown));
  }
  if (!may_be_asked(host, allowed)) {
    return fmt::format(
        "refused a client that asked for the host '{0}'; --allow-origin http://{0} "
        "admits it",
        without_port(host).substr(0, kMostShown));
  }
  return "";
}

}  // namespace pillarfield
