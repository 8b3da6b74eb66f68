#pragma once

#include <bitset>
#include <cstddef>
#include <span>
#include <string>

#include "streams/message/contact_slots.h"
#include "streams/message/schemas.h"

namespace pillarfield {

/// A topic of ROS 2 messages.
struct Topic {
  std::string name;
  const MessageSchema* schema = nullptr;
};

/// Indices in topics().
namespace topic {
inline constexpr std::size_t kNormal = 0;
inline constexpr std::size_t kRaw = 1;
inline constexpr std::size_t kForces = 2;
inline constexpr std::size_t kArrows = 3;
inline constexpr std::size_t kHealth = 4;
inline constexpr std::size_t kTime = 5;
inline constexpr std::size_t kContacts = 6;  ///< the first of ContactSlots::kSlots
}  // namespace topic

inline constexpr std::size_t kTopics = topic::kContacts + ContactSlots::kSlots;
using TopicSet = std::bitset<kTopics>;

[[nodiscard]] std::span<const Topic> topics();

/// The topics /skin/contacts/1, /skin/contacts/2, ...
[[nodiscard]] TopicSet contact_topics();

}  // namespace pillarfield
