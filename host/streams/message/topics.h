#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "pillarfield/contact_tracker.h"

namespace pillarfield {

/// Numbered places of contacts. A contact keeps its place while it lives; a new one takes the
/// lowest free place. Contacts beyond the last place have none.
class ContactSlots {
 public:
  static constexpr std::size_t kSlots = 16;

  struct Slot {
    const TrackedContact* contact = nullptr;  ///< null: free
    bool ended = false;                       ///< its contact ended with this frame
  };

  /// The places in this frame; the contacts must outlive their use.
  const std::array<Slot, kSlots>& update(const FrameContacts& contacts);

 private:
  std::array<std::uint64_t, kSlots> tracks_ = {};  // track_id; 0: free
  std::array<Slot, kSlots> slots_;
};

/// The definition of a ROS 2 message.
struct MessageSchema {
  std::string name;        ///< "sensor_msgs/msg/Image"
  std::string definition;  ///< `ros2msg`: its members, then those of the messages it contains
};

/// Definitions as of ROS 2 Humble and later, with its package foxglove_msgs.
[[nodiscard]] const MessageSchema& image_schema();
[[nodiscard]] const MessageSchema& point_cloud_schema();
[[nodiscard]] const MessageSchema& grid_schema();
[[nodiscard]] const MessageSchema& wrench_schema();
[[nodiscard]] const MessageSchema& marker_array_schema();
[[nodiscard]] const MessageSchema& diagnostics_schema();
[[nodiscard]] const MessageSchema& time_reference_schema();

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
inline constexpr std::size_t kField = 3;
inline constexpr std::size_t kArrows = 4;
inline constexpr std::size_t kHealth = 5;
inline constexpr std::size_t kTime = 6;
inline constexpr std::size_t kContacts = 7;  ///< the first of ContactSlots::kSlots
}  // namespace topic

inline constexpr std::size_t kTopics = topic::kContacts + ContactSlots::kSlots;
using TopicSet = std::bitset<kTopics>;

[[nodiscard]] std::span<const Topic> topics();

/// The topics /skin/contacts/1, /skin/contacts/2, ...
[[nodiscard]] TopicSet contact_topics();

}  // namespace pillarfield
