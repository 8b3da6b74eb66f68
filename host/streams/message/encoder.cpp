#include "streams/message/encoder.h"

#include <algorithm>

#include "pillarfield/printable.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostArrows = 500;
constexpr std::chrono::nanoseconds kArrowInterval{33'000'000};

bool has_normal(const ForceFieldView& forces, std::size_t pillars) {
  return forces.normal.size() == pillars && forces.status.size() == pillars;
}

bool has_shear(const ForceFieldView& forces, std::size_t pillars) {
  return forces.shear_x.size() == pillars && forces.shear_y.size() == pillars;
}

}  // namespace

MessageEncoder::MessageEncoder(const LiveSinkInfo& info)
    : geometry_(info), source_(printable(info.forces.source)) {}

/// Passes a message that `put` writes.
template <class Put>
void MessageEncoder::pass(std::size_t topic, std::uint32_t sequence, const Receiver& receiver,
                          const Put& put) {
  CdrWriter cdr(bytes_);
  put(cdr);
  receiver({topic, sequence, stamp_, bytes_});
}

void MessageEncoder::encode(const SolvedFrame& frame, const TopicSet& wanted,
                            const Receiver& receiver) {
  stamp_ = clock_.real_time(frame.arrived);
  const auto sequence = static_cast<std::uint32_t>(frame.sequence);
  const auto pass_if = [&](std::size_t topic, bool at_hand, const auto& put) {
    if (wanted[topic] && at_hand) pass(topic, sequence, receiver, put);
  };
  const ForceFieldView& forces = frame.forces;
  const std::size_t pillars = geometry_.poses().size();
  const bool has_field = has_normal(forces, pillars);
  pass_if(topic::kTime, true,
          [&](CdrWriter& cdr) { message::put_time(cdr, stamp_, frame.time_s, source_); });
  pass_if(topic::kNormal, has_field,
          [&](CdrWriter& cdr) { message::put_normal_image(cdr, stamp_, forces); });
  pass_if(topic::kRaw, frame.readings.data != nullptr,
          [&](CdrWriter& cdr) { message::put_raw_image(cdr, stamp_, frame.readings); });
  pass_if(topic::kForces, has_field && has_shear(forces, pillars), [&](CdrWriter& cdr) {
    message::put_points(cdr, stamp_, forces, geometry_.poses(), touched_);
  });
  pass_if(topic::kField, has_field,
          [&](CdrWriter& cdr) { message::put_field(cdr, stamp_, forces, geometry_); });
  if (frame.contacts == nullptr) return;
  const Slots& slots = slots_.update(*frame.contacts);
  encode_wrenches(slots, wanted, sequence, receiver);
  if (!wanted[topic::kArrows] || !arrows_are_due()) return;
  list_arrows(*frame.contacts, slots);
  pass(topic::kArrows, sequence, receiver,
       [&](CdrWriter& cdr) { message::put_arrows(cdr, stamp_, arrows_, geometry_); });
}

void MessageEncoder::encode_wrenches(const Slots& slots, const TopicSet& wanted,
                                     std::uint32_t sequence, const Receiver& receiver) {
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    const TrackedContact* const contact = slots[slot].contact;
    if (!wanted[topic::kContacts + slot] || (contact == nullptr && !slots[slot].ended)) continue;
    pass(topic::kContacts + slot, sequence, receiver, [&](CdrWriter& cdr) {
      message::put_wrench(cdr, stamp_, contact != nullptr ? &contact->quantities : nullptr);
    });
  }
}

bool MessageEncoder::arrows_are_due() {
  if (arrows_sent_ && stamp_ - *arrows_sent_ < kArrowInterval) return false;
  arrows_sent_ = stamp_;
  return true;
}

/// Lists the contacts with the largest normal forces. Contacts with a topic bear its name.
void MessageEncoder::list_arrows(const FrameContacts& contacts, const Slots& slots) {
  arrows_.clear();
  for (const TrackedContact& contact : contacts.contacts) {
    arrows_.push_back({&contact, "contacts"});
  }
  if (arrows_.size() > kMostArrows) {
    std::ranges::nth_element(
        arrows_, arrows_.begin() + kMostArrows, std::greater(),
        [](const message::Arrow& arrow) { return arrow.contact->quantities.normal_n; });
    arrows_.resize(kMostArrows);
  }
  for (message::Arrow& arrow : arrows_) {
    const auto* const slot = std::ranges::find(slots, arrow.contact, &ContactSlots::Slot::contact);
    if (slot == slots.end()) continue;
    const auto place = static_cast<std::size_t>(slot - slots.begin());
    arrow.name_space = topics()[topic::kContacts + place].name;
  }
}

void MessageEncoder::encode(const HealthReport& health, const Receiver& receiver) {
  stamp_ = clock_.real_time({});
  pass(topic::kHealth, 0, receiver,
       [&](CdrWriter& cdr) { message::put_health(cdr, stamp_, health, source_, lost_); });
  lost_ = health.stream.lost;
}

}  // namespace pillarfield
