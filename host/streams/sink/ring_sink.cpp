#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "streams/live_sink.h"
#include "streams/message/host_clock.h"
#include "streams/ring/ring_contact.h"
#include "streams/ring/ring_writer.h"

namespace pillarfield {
namespace {

constexpr std::string_view kRingPrefix = "shm:";
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

RingLayout layout_of_results(const Skin& skin) {
  return {skin.has_pillars() ? PILLARFIELD_RING_RESULTS : PILLARFIELD_RING_PRESSURES,
          skin.element_rows(), skin.element_cols(), 0, skin.element_pitch_mm()};
}

double sum_of(std::span<const float> plane) {
  double sum = 0;
  for (const float value : plane) sum += std::isfinite(value) ? static_cast<double>(value) : 0;
  return sum;
}

/// The total of a frame whose contacts are not found.
PillarfieldContact total_of(const ForceFieldView& forces) {
  ContactQuantities total;
  total.shear_x_n = sum_of(forces.shear_x);
  total.shear_y_n = sum_of(forces.shear_y);
  total.normal_n = sum_of(forces.normal);
  total.has_shear = !forces.shear_x.empty();
  total.torque_nmm = total.area_mm2 = total.peak_n = kUnknown;
  total.centre_of_pressure = total.centre = total.peak = {kUnknown, kUnknown};
  return ring_contact(total);
}

class RingSink final : public LiveSink {
 public:
  RingSink(std::string name, const Skin& skin)
      : name_(std::move(name)), layout_(layout_of_results(skin)) {
    writer_.emplace(name_.substr(kRingPrefix.size()), layout_, slots_for(layout_));
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] LiveSinkStatistics statistics() const override { return done_; }
  void append(const SolvedFrame& frame) override;
  void finish() override { writer_.reset(); }

 private:
  void write_head(PillarfieldResultSlot& slot, const SolvedFrame& frame);
  void write_contacts(PillarfieldResultSlot& slot, const FrameContacts& contacts);

  std::string name_;
  RingLayout layout_;
  std::optional<RingWriter> writer_;
  HostClock clock_;
  std::vector<const TrackedContact*> strongest_;
  LiveSinkStatistics done_;
};

void RingSink::append(const SolvedFrame& frame) {
  if (!writer_) return;
  const ForceFieldView& forces = frame.forces;
  if (forces.rows != layout_.rows || forces.cols != layout_.cols) {
    done_.failure = name_ + ": the field has another size";
    return writer_.reset();
  }
  std::byte* const slot = writer_->begin().data();
  write_head(*reinterpret_cast<PillarfieldResultSlot*>(slot), frame);
  std::byte* place = slot + sizeof(PillarfieldResultSlot);
  for (const std::span plane : {forces.shear_x, forces.shear_y, forces.normal}) {
    if (!plane.empty()) std::memcpy(place, plane.data(), plane.size_bytes());
    place += plane.size_bytes();
  }
  std::memcpy(place, forces.status.data(), forces.status.size());
  if (!writer_->publish()) {
    done_.failure = "another program shortened the shared memory";
    return writer_.reset();
  }
  ++done_.frames;
}

void RingSink::write_head(PillarfieldResultSlot& slot, const SolvedFrame& frame) {
  slot.sequence = frame.sequence;
  slot.time_s = frame.time_s;
  slot.arrived_ns = static_cast<std::uint64_t>(frame.arrived.count());
  slot.arrived_unix_ns = static_cast<std::uint64_t>(clock_.real_time(frame.arrived).count());
  slot.published_ns = static_cast<std::uint64_t>(
      std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
  slot.missing = frame.missing.empty() ? 0 : 1;
  slot.contacts = 0;
  slot.contacts_found = 0;
  if (frame.contacts == nullptr) {
    slot.total = total_of(frame.forces);
  } else {
    write_contacts(slot, *frame.contacts);
  }
}

void RingSink::write_contacts(PillarfieldResultSlot& slot, const FrameContacts& contacts) {
  slot.total = ring_contact(contacts.total);
  slot.contacts_found = contacts.contacts.size();
  const std::size_t count =
      std::min<std::size_t>(contacts.contacts.size(), PILLARFIELD_MAX_CONTACTS);
  strongest_.clear();
  for (const TrackedContact& contact : contacts.contacts) strongest_.push_back(&contact);
  std::ranges::partial_sort(
      strongest_, strongest_.begin() + static_cast<std::ptrdiff_t>(count), std::greater(),
      [](const TrackedContact* contact) { return contact->quantities.normal_n; });
  slot.contacts = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    slot.contact[i] = ring_contact(*strongest_[i]);
  }
}

std::unique_ptr<LiveSink> create_ring_sink(const std::string& target, const LiveSinkInfo& info) {
  return std::make_unique<RingSink>(target, info.skin);
}

}  // namespace

/// `shm:NAME`: a ring of results in shared memory (stream_format.h). append() writes into it and
/// never waits.
LiveSinkKind ring_sink_kind() {
  return {.prefix = kRingPrefix, .form = "shm:NAME", .create = create_ring_sink};
}

}  // namespace pillarfield
