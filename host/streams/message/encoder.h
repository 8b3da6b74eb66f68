#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/live.h"
#include "streams/message/host_clock.h"
#include "streams/message/messages.h"
#include "streams/message/topics.h"

namespace pillarfield {

/// An encoded message.
struct EncodedMessage {
  std::size_t topic = 0;              ///< in topics()
  std::uint32_t sequence = 0;         ///< of the frame, modulo 2^32
  std::chrono::nanoseconds stamp{0};  ///< arrival of the frame, since 1970
  std::span<const std::byte> bytes;   ///< valid during the call
};

/// Encodes solved frames and reports of health as ROS 2 messages (docs/streams.md).
class MessageEncoder {
 public:
  using Receiver = std::function<void(const EncodedMessage&)>;

  explicit MessageEncoder(const LiveSinkInfo& info);

  /// Passes one message of each topic of `wanted` that the frame has the parts for; arrows at most
  /// 30 times a second.
  void encode(const SolvedFrame& frame, const TopicSet& wanted, const Receiver& receiver);
  void encode(const HealthReport& health, const Receiver& receiver);

 private:
  using Slots = std::array<ContactSlots::Slot, ContactSlots::kSlots>;

  void encode_wrenches(const Slots& slots, const TopicSet& wanted, std::uint32_t sequence,
                       const Receiver& receiver);
  void list_arrows(const FrameContacts& contacts, const Slots& slots);
  [[nodiscard]] bool arrows_are_due();
  template <class Put>
  void pass(std::size_t topic, std::uint32_t sequence, const Receiver& receiver, const Put& put);

  SkinGeometry geometry_;
  HostClock clock_;
  std::string source_;
  ContactSlots slots_;
  std::chrono::nanoseconds stamp_{0};  // of the frame
  std::optional<std::chrono::nanoseconds> arrows_sent_;
  std::uint64_t lost_ = 0;  // at the last report
  // Memory that frames reuse.
  std::vector<message::Arrow> arrows_;
  std::vector<std::uint32_t> touched_;
  std::vector<std::byte> bytes_;
};

}  // namespace pillarfield
