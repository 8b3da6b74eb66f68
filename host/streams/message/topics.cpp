#include "streams/message/topics.h"

#include <array>

namespace pillarfield {

std::span<const Topic> topics() {
  static const auto all = [] {
    std::array<Topic, kTopics> list;
    list[topic::kNormal] = {"/skin/normal", &image_schema()};
    list[topic::kRaw] = {"/skin/raw", &image_schema()};
    list[topic::kForces] = {"/skin/forces", &point_cloud_schema()};
    list[topic::kArrows] = {"/skin/arrows", &marker_array_schema()};
    list[topic::kHealth] = {"/skin/health", &diagnostics_schema()};
    list[topic::kTime] = {"/skin/time", &time_reference_schema()};
    for (std::size_t slot = 0; slot < ContactSlots::kSlots; ++slot) {
      list[topic::kContacts + slot] = {"/skin/contacts/" + std::to_string(slot + 1),
                                       &wrench_schema()};
    }
    return list;
  }();
  return all;
}

TopicSet contact_topics() { return TopicSet().set() << topic::kContacts; }

}  // namespace pillarfield
