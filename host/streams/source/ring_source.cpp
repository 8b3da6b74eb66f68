#include <cstring>

#include "streams/live_source.h"
#include "streams/ring/ring_reader.h"
#include "streams/source/packet_source.h"

namespace pillarfield {
namespace {

/// Frames of a ring in shared memory.
class RingSource final : public PacketSource {
 public:
  explicit RingSource(const std::string& name) : reader_(name, RingReader::Content::frames) {}

  [[nodiscard]] Arrival receive(Packet& packet, std::chrono::nanoseconds timeout) override;
  [[nodiscard]] StoredSkin stated(const Packet& packet) const override;
  [[nodiscard]] Counts counts() const override;

 private:
  RingReader reader_;
};

Arrival RingSource::receive(Packet& packet, std::chrono::nanoseconds timeout) {
  const std::byte* const slot = reader_.read(timeout);
  if (slot == nullptr) return Arrival::timed_out;
  packet.arrived = steady_now();
  std::memcpy(&packet.header, slot + offsetof(PillarfieldFrameSlot, packet), sizeof packet.header);
  const std::size_t bytes = *content_bytes(*reader_.layout()) - sizeof(PillarfieldFrameSlot);
  packet.bytes = {slot + sizeof(PillarfieldFrameSlot), bytes};
  return Arrival::arrived;
}

StoredSkin RingSource::stated(const Packet& packet) const {
  PillarfieldConstants constants = {};
  std::memcpy(&constants,
              packet.bytes.data() - sizeof(PillarfieldFrameSlot) +
                  offsetof(PillarfieldFrameSlot, constants),
              sizeof constants);
  return stated_by(constants);
}

PacketSource::Counts RingSource::counts() const {
  Counts counts = {reader_.invalid(), reader_.overrun()};
  if (const auto& other = reader_.other()) {
    counts.other =
        FrameShape{reading_type(other->type).value_or(SenselType::u8), other->rows, other->cols};
  }
  return counts;
}

std::unique_ptr<FrameStream> open_ring(const std::string& rest, const LiveSourceOptions& options) {
  return open_packet_stream("shm:" + rest, std::make_unique<RingSource>(rest), PacketOrder::kept,
                            options);
}

}  // namespace

LiveSourceKind ring_kind() { return {"shm:", "shm:NAME", open_ring}; }

}  // namespace pillarfield
