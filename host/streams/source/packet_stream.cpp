#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "streams/source/packet_source.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

/// A packet with its bytes.
struct KeptPacket {
  explicit KeptPacket(const Packet& packet)
      : header(packet.header),
        bytes(packet.bytes.begin(), packet.bytes.end()),
        arrived(packet.arrived) {}
  PillarfieldPacket header;
  std::vector<std::byte> bytes;
  nanoseconds arrived;
};

/// The packets of a source until its frames are known: until as many bytes of one shape have come
/// as a frame of it has. So a header alone, which may claim any size, allocates nothing.
class FirstPackets {
 public:
  /// `size` throws Error, naming `name`, for frames of another size, or passes over them if the
  /// source is open to all.
  FirstPackets(const std::string& name, bool is_open_to_all, const std::optional<FrameSize>& size)
      : name_(name), is_open_to_all_(is_open_to_all), size_(size) {}

  /// Takes a packet, which states these constants; whether the shape is known now.
  bool add(const Packet& packet, const StoredSkin& stated);

  [[nodiscard]] const FrameShape& shape() const { return *shape_; }
  [[nodiscard]] const StoredSkin& stated() const { return stated_; }
  [[nodiscard]] std::vector<KeptPacket> take() { return std::move(packets_); }
  /// Packets that are not kept.
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }
  /// Description of frames of another size that came; empty: none.
  [[nodiscard]] const std::string& mismatch() const { return mismatch_; }

 private:
  [[nodiscard]] bool has_size(const FrameShape& shape);

  const std::string& name_;
  bool is_open_to_all_;
  std::optional<FrameSize> size_;
  std::optional<FrameShape> shape_;
  StoredSkin stated_;
  std::vector<KeptPacket> packets_;
  std::size_t bytes_ = 0;
  std::uint64_t invalid_ = 0;
  std::string mismatch_;
};

bool FirstPackets::has_size(const FrameShape& shape) {
  if (!size_ || (shape.rows == size_->rows && shape.cols == size_->cols)) return true;
  mismatch_ = mismatch_words(shape, {shape.type, size_->rows, size_->cols});
  if (is_open_to_all_) return false;
  throw Error(name_, mismatch_, "give the calibration or scene of this sensor");
}

bool FirstPackets::add(const Packet& packet, const StoredSkin& stated) {
  const auto shape = shape_of(packet.header);
  if (!shape || !is_intact(packet) || !has_size(*shape)) {
    ++invalid_;
    return false;
  }
  const PillarfieldContent content = content_of(packet.header);
  if (content == PILLARFIELD_END) return false;
  if (shape != shape_) {
    invalid_ += packets_.size();
    packets_.clear();
    bytes_ = 0;
    shape_ = shape;
    stated_ = {};
  }
  if (content != PILLARFIELD_ROWS) stated_ = stated;
  if (content == PILLARFIELD_CONSTANTS) return false;
  packets_.emplace_back(packet);
  bytes_ += packet.bytes.size();
  return bytes_ >= shape->bytes();
}

class PacketStream final : public FrameStream {
 public:
  PacketStream(std::unique_ptr<PacketSource> source, FirstPackets& first, PacketOrder order,
               Skin skin, bool mirrors, const LiveSourceOptions& options)
      : source_(std::move(source)),
        first_(first.take()),
        assembler_(first.shape(), order),
        skin_(std::move(skin)),
        mirrors_(mirrors),
        newest_(options.newest),
        calibration_(options.calibration) {
    assembler_.set_counts({.invalid = first.invalid()});
  }

  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return assembler_.shape().type; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] StreamHealth health() const override;
  [[nodiscard]] Arrival next(StreamedFrame& frame, nanoseconds timeout) override;

 private:
  bool pop(StreamedFrame& frame);
  [[nodiscard]] Arrival next_of_all(StreamedFrame& frame, nanoseconds timeout);
  [[nodiscard]] Arrival receive(Packet& packet, nanoseconds timeout);

  std::unique_ptr<PacketSource> source_;
  std::vector<KeptPacket> first_;  ///< received while the stream was opened
  std::size_t next_first_ = 0;
  FrameAssembler assembler_;
  Skin skin_;
  bool mirrors_;  ///< falling readings
  bool newest_;   ///< LiveSourceOptions::newest
  std::uint64_t dropped_ = 0;
  Calibration calibration_;
};

StreamHealth PacketStream::health() const {
  StreamHealth health = assembler_.health(steady_now());
  const PacketSource::Counts counts = source_->counts();
  health.invalid += counts.invalid;
  health.overrun += counts.overrun + dropped_;
  health.lost += dropped_;
  health.frames -= dropped_;
  const std::optional<FrameShape>& other = assembler_.other() ? assembler_.other() : counts.other;
  if (other) health.mismatch = mismatch_words(*other, assembler_.shape());
  return health;
}

Arrival PacketStream::receive(Packet& packet, nanoseconds timeout) {
  if (next_first_ == first_.size()) {
    first_ = {};
    next_first_ = 0;
    return source_->receive(packet, timeout);
  }
  const KeptPacket& kept = first_[next_first_++];
  packet = {kept.header, kept.bytes, kept.arrived};
  return Arrival::arrived;
}

bool PacketStream::pop(StreamedFrame& frame) {
  const bool popped = assembler_.pop(frame);
  if (popped && mirrors_) mirror(frame.buffer);
  return popped;
}

Arrival PacketStream::next(StreamedFrame& frame, nanoseconds timeout) {
  const Arrival arrival = next_of_all(frame, timeout);
  if (!newest_ || arrival != Arrival::arrived) return arrival;
  const nanoseconds until = steady_now() + 100ms;  // of a sensor that is faster than this loop
  while (steady_now() < until && next_of_all(frame, 0ns) == Arrival::arrived) ++dropped_;
  return arrival;
}

Arrival PacketStream::next_of_all(StreamedFrame& frame, nanoseconds timeout) {
  constexpr int kMostPackets = 4096;  // of a sensor that is faster than this loop
  const nanoseconds until = steady_now() + std::clamp<nanoseconds>(timeout, 0ns, 24h);
  Packet packet;
  for (int packets = 0; packets < kMostPackets;) {
    if (pop(frame)) return Arrival::arrived;
    const nanoseconds deadline = std::min(assembler_.deadline().value_or(until), until);
    const Arrival arrival = receive(packet, std::max(deadline - steady_now(), 0ns));
    if (arrival == Arrival::arrived) {
      assembler_.add(packet);
      ++packets;
      continue;
    }
    const nanoseconds now = steady_now();
    if (arrival == Arrival::ended || now >= assembler_.deadline().value_or(24h * 36500)) {
      assembler_.give_up();
    }
    if (pop(frame)) return Arrival::arrived;
    if (arrival == Arrival::ended) return Arrival::ended;
    if (now >= until) break;
  }
  return Arrival::timed_out;
}

/// Waits until the source's frames are known; false if the user gave up.
bool receive_first(const std::string& name, PacketSource& source, const LiveSourceOptions& options,
                   FirstPackets& first) {
  constexpr nanoseconds kPoll = 100ms;
  const nanoseconds began = steady_now();
  Packet packet;
  bool said = false;
  for (nanoseconds polled = began;;) {
    const nanoseconds left =
        options.most_wait ? *options.most_wait - (steady_now() - began) : kPoll;
    const Arrival arrival = source.receive(packet, std::clamp<nanoseconds>(left, 0ns, kPoll));
    if (arrival == Arrival::ended) {
      throw Error(name, "ended before its first frame", "docs/streams.md describes the packets");
    }
    if (arrival == Arrival::arrived && first.add(packet, source.stated(packet))) return true;
    const std::string words = first.mismatch().empty() ? source.complaint() : first.mismatch();
    if (options.say && !said && !words.empty()) {
      said = true;
      options.say(words);
    }
    const nanoseconds now = steady_now();
    if (options.most_wait && now - began >= *options.most_wait) {
      throw Error(name,
                  fmt::format("no frame came in {:.3g} s{}{}",
                              std::chrono::duration<double>(*options.most_wait).count(),
                              words.empty() ? "" : ": ", words),
                  "start its sender, or wait longer");
    }
    if (now - polled < kPoll) continue;
    polled = now;
    if (options.stop && options.stop()) return false;
  }
}

/// The skin of the frames, which state these constants.
Skin skin_of_frames(const FrameShape& shape, StoredSkin stated, const LiveSourceOptions& options) {
  Skin skin;
  if (options.skin) {
    skin = *options.skin;
    if (skin.states_pitch()) stated.sensel_pitch_mm = skin.sensel_pitch_mm;
    if (skin.states_counts_per_newton()) stated.counts_per_newton = skin.counts_per_newton;
    if (skin.threshold_counts > 0) stated.threshold_counts = skin.threshold_counts;
    if (skin.full_scale_counts) stated.full_scale_counts = skin.full_scale_counts;
    if (skin.stated.layout || !skin.has_pillars()) stated.layout = skin.layout;
    stated.power_law = skin.power_law;
    const bool is_stated = options.read.layout || stated.layout;
    if (!is_stated && options.say) {
      for (const std::string& sentence : layout_warnings(skin)) options.say(sentence);
    }
    if (!is_stated) stated.layout = skin.layout;
  }
  skin.rows = shape.rows;
  skin.cols = shape.cols;
  take_constants(skin, stated, options.read);
  return skin;
}

}  // namespace

std::unique_ptr<FrameStream> open_packet_stream(const std::string& name,
                                                std::unique_ptr<PacketSource> source,
                                                PacketOrder order,
                                                const LiveSourceOptions& options) {
  FirstPackets first(name, source->is_open_to_all(), options.size);
  if (!receive_first(name, *source, options, first)) return nullptr;
  Skin skin = skin_of_frames(first.shape(), first.stated(), options);
  check(skin, name);
  check(options.calibration, skin, name, first.shape().type);
  source->prepare(first.shape());
  const bool mirrors = options.read.falling && !first.stated().falling;
  return std::make_unique<PacketStream>(std::move(source), first, order, std::move(skin), mirrors,
                                        options);
}

}  // namespace pillarfield
