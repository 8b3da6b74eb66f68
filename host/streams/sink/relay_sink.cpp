#include <chrono>
#include <optional>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/live.h"
#include "pillarfield/printable.h"
#include "pillarfield/stream_format.h"
#include "streams/ring/ring_writer.h"

namespace pillarfield {
namespace {

constexpr std::string_view kRelayPrefix = "shm:";

PillarfieldReadingType type_in_ring(SenselType type) {
  if (type == SenselType::u8) return PILLARFIELD_U8;
  return type == SenselType::u16 ? PILLARFIELD_U16 : PILLARFIELD_F32;
}

/// The constants that readers use for the frames: those of the plan, without assumed ones.
PillarfieldConstants constants_of(const Skin& skin) {
  PillarfieldConstants constants = {};
  constants.layout = skin.has_pillars() ? PILLARFIELD_PILLARS : PILLARFIELD_SENSELS;
  constants.mirrored = skin.falling ? 1 : 0;
  if (skin.states_pitch()) {
    constants.pitch_x_mm = skin.sensel_pitch_mm.col_mm;
    constants.pitch_y_mm = skin.sensel_pitch_mm.row_mm;
  }
  if (skin.states_counts_per_newton()) constants.counts_per_newton = skin.counts_per_newton;
  constants.threshold_counts = skin.threshold_counts;
  constants.full_scale_counts = skin.full_scale_counts.value_or(0);
  return constants;
}

class RelaySink final : public LiveSink {
 public:
  RelaySink(const std::string& target, const LiveSinkInfo& info)
      : name_(target),
        layout_{PILLARFIELD_RING_FRAMES, info.skin.rows, info.skin.cols,
                type_in_ring(info.sensel_type)},
        constants_(constants_of(info.skin)) {
    check_live_relay(target);
    writer_.emplace(target.substr(kRelayPrefix.size()), layout_, slots_for(layout_));
  }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] LiveSinkStatistics statistics() const override { return done_; }
  void append(const SolvedFrame& frame) override;
  void finish() override { writer_.reset(); }

 private:
  std::string name_;
  RingLayout layout_;
  PillarfieldConstants constants_;
  std::uint64_t session_ =
      static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  std::optional<RingWriter> writer_;
  LiveSinkStatistics done_;
};

/// A ring has whole frames; its readers count the others as lost.
void RelaySink::append(const SolvedFrame& frame) {
  constexpr double kOriginSeconds = 1;  // Zero would mean that the sensor has no clock.
  if (!writer_) return;
  if (frame.readings.data == nullptr || !frame.missing.empty()) {
    ++done_.dropped;
    return;
  }
  const std::size_t bytes = std::size_t{layout_.rows} * layout_.cols * size_of(frame.readings.type);
  std::byte* const slot = writer_->begin().data();
  reinterpret_cast<PillarfieldFrameSlot*>(slot)->constants = constants_;
  reinterpret_cast<PillarfieldFrameSlot*>(slot)->packet = {
      .magic = PILLARFIELD_PACKET_MAGIC,
      .content = PILLARFIELD_FRAME,
      .type = static_cast<std::uint16_t>(layout_.type),
      .rows = layout_.rows,
      .cols = layout_.cols,
      .session = session_,
      .sequence = frame.sequence,
      .time_ns = static_cast<std::uint64_t>(1e9 * (kOriginSeconds + frame.time_s)),
      .part = 0,
      .parts = 1,
      .first = 0,
      .count = 0,
      .patch = 0,
      .bytes = static_cast<std::uint32_t>(bytes)};
  copy_readings(frame.readings, slot + sizeof(PillarfieldFrameSlot));
  if (writer_->publish()) {
    ++done_.frames;
    return;
  }
  done_.failure = "another program shortened the shared memory";
  writer_.reset();
}

}  // namespace

void check_live_relay(const std::string& target) {
  if (target.starts_with(kRelayPrefix)) return;
  throw Error(printable(target), "frames are relayed into shared memory", "give shm:NAME");
}

std::unique_ptr<LiveSink> create_live_relay(const std::string& target, const LiveSinkInfo& info) {
  return std::make_unique<RelaySink>(target, info);
}

}  // namespace pillarfield
