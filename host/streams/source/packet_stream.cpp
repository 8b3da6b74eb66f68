#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "streams/source/packet_source.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

class PacketStream final : public FrameStream {
 public:
  PacketStream(std::unique_ptr<PacketSource> source, const FrameShape& shape, PacketOrder order,
               const LiveSourceOptions& options)
      : source_(std::move(source)),
        assembler_(shape, order),
        skin_(options.skin),
        calibration_(options.calibration) {}

  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return assembler_.shape().type; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] StreamHealth health() const override;
  void discard_waiting() override;
  [[nodiscard]] Arrival next(StreamedFrame& frame, nanoseconds timeout) override;

  /// Adds the packet that the source received when the stream was opened, after `invalid` others.
  void begin(const Packet& packet, std::uint64_t invalid) {
    assembler_.set_counts({.invalid = invalid});
    assembler_.add(packet);
  }

 private:
  std::unique_ptr<PacketSource> source_;
  FrameAssembler assembler_;
  Skin skin_;
  Calibration calibration_;
};

StreamHealth PacketStream::health() const {
  StreamHealth health = assembler_.health(steady_now());
  const PacketSource::Counts counts = source_->counts();
  health.invalid += counts.invalid;
  health.overrun += counts.overrun;
  return health;
}

void PacketStream::discard_waiting() {
  if (source_->holds_sender_back()) return;
  const StreamHealth before = health();
  const nanoseconds until = steady_now() + 200ms;  // for a sensor that is faster than this loop
  StreamedFrame frame(sensel_type(), skin_);
  Packet packet;
  do {
    while (assembler_.pop(frame)) {
    }
    if (source_->receive(packet, 0ns) != Arrival::arrived) break;
    assembler_.add(packet);
  } while (steady_now() < until);
  assembler_.discard();
  assembler_.set_counts(before);
  source_->clear_counts();
}

Arrival PacketStream::next(StreamedFrame& frame, nanoseconds timeout) {
  constexpr int kMostPackets = 4096;  // of a sensor that is faster than this loop
  const nanoseconds until = steady_now() + std::clamp<nanoseconds>(timeout, 0ns, 24h);
  Packet packet;
  for (int packets = 0; packets < kMostPackets;) {
    if (assembler_.pop(frame)) return Arrival::arrived;
    const nanoseconds deadline = std::min(assembler_.deadline().value_or(until), until);
    const Arrival arrival = source_->receive(packet, std::max(deadline - steady_now(), 0ns));
    if (arrival == Arrival::arrived) {
      assembler_.add(packet);
      ++packets;
      continue;
    }
    const nanoseconds now = steady_now();
    if (arrival == Arrival::ended || now >= assembler_.deadline().value_or(24h * 36500)) {
      assembler_.give_up();
    }
    if (assembler_.pop(frame)) return Arrival::arrived;
    if (arrival == Arrival::ended) return Arrival::ended;
    if (now >= until) break;
  }
  return Arrival::timed_out;
}

/// Waits for the first valid packet; its shape, or none if the user gave up.
std::optional<FrameShape> receive_first(const std::string& name, PacketSource& source,
                                        const std::function<bool()>& stop, Packet& packet,
                                        std::uint64_t& invalid) {
  constexpr nanoseconds kPoll = 100ms;
  for (nanoseconds polled = steady_now();;) {
    const Arrival arrival = source.receive(packet, kPoll);
    if (arrival == Arrival::ended) {
      throw Error(name, "ended before its first frame", "docs/streams.md describes the packets");
    }
    if (arrival == Arrival::arrived) {
      const auto shape = shape_of(packet.header);
      const bool is_valid = shape && is_intact(packet, *shape);
      if (is_valid && content_of(packet.header) != PILLARFIELD_END) return shape;
      if (!is_valid) ++invalid;
    }
    if (steady_now() - polled < kPoll) continue;
    polled = steady_now();
    if (stop && stop()) return std::nullopt;
  }
}

}  // namespace

std::unique_ptr<FrameStream> open_packet_stream(const std::string& name,
                                                std::unique_ptr<PacketSource> source,
                                                PacketOrder order,
                                                const LiveSourceOptions& options) {
  Packet packet;
  std::uint64_t invalid = 0;
  const auto shape = receive_first(name, *source, options.stop, packet, invalid);
  if (!shape) return nullptr;
  LiveSourceOptions fitting = options;
  fitting.skin.rows = shape->rows;
  fitting.skin.cols = shape->cols;
  check(fitting.skin, name);
  check(fitting.calibration, fitting.skin, name, shape->type);
  source->prepare(*shape);
  auto stream = std::make_unique<PacketStream>(std::move(source), *shape, order, fitting);
  stream->begin(packet, invalid);
  return stream;
}

}  // namespace pillarfield
