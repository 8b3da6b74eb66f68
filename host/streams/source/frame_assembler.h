#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "pillarfield/frame_stream.h"
#include "streams/source/packet.h"
#include "streams/source/sessions.h"

namespace pillarfield {

/// Counts events per second, over the last second in eighths.
class RateMeter {
 public:
  using Time = std::chrono::nanoseconds;

  void count(Time now) {
    advance(now);
    ++counts_[static_cast<std::size_t>(eighth_ % kKept)];
  }

  /// Events per second. Exact for a steady rate once it has lasted a second.
  [[nodiscard]] double rate_hz(Time now) {
    advance(now);
    const std::uint64_t all = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
    const std::uint64_t current = counts_[static_cast<std::size_t>(eighth_ % kKept)];
    const auto eighths = static_cast<double>(std::min(eighth_ - first_, kKept - 1));
    return eighths > 0 ? static_cast<double>(all - current) * 8 / eighths : 0;
  }

 private:
  static constexpr std::int64_t kKept = 9;  ///< eight whole ones, and the current one

  void advance(Time now) {
    const std::int64_t eighth = now / std::chrono::milliseconds(125);
    if (first_ < 0) first_ = eighth_ = eighth;
    if (eighth - eighth_ >= kKept) {
      counts_ = {};
      eighth_ = eighth;
    }
    while (eighth_ < eighth) counts_[static_cast<std::size_t>(++eighth_ % kKept)] = 0;
  }

  std::array<std::uint64_t, kKept> counts_ = {};
  std::int64_t eighth_ = 0;
  std::int64_t first_ = -1;
};

/// Remembers which parts of the latest frames came.
class PartHistory {
 public:
  explicit PartHistory(std::uint32_t most_parts);

  /// Notes a part; false if it came before, or its frame is too old to tell.
  bool add(std::uint64_t sequence, std::uint32_t part);

  /// True if add() can tell: the frame is not too old.
  [[nodiscard]] bool reaches(std::uint64_t sequence) const;

  void clear();

  static constexpr std::uint64_t kFrames = 64;

 private:
  struct Frame {
    std::uint64_t sequence = 0;
    bool known = false;
    std::vector<std::uint64_t> parts;  ///< a bit for each
    std::uint32_t words = 0;           ///< of `parts` that may not be zero
  };
  std::array<Frame, kFrames> frames_;
};

/// Number of frames that may be under way at once.
enum class PacketOrder : std::uint8_t {
  kept = 1,      ///< packets arrive as they were sent: a later frame ends an incomplete one
  not_kept = 2,  ///< the frame after the next ends an incomplete one
};

/// Assembles the packets of a stream to frames, in order, and counts what is wrong with them.
///
/// An incomplete frame is given up when a packet of a later frame shows that no more will come
/// (PacketOrder), or after two frame intervals without a packet. It is delivered if one of its
/// packets came, and lost otherwise. A stream that starts in the middle of a frame does not count
/// that frame. Allocates only at construction.
class FrameAssembler {
 public:
  using Time = std::chrono::nanoseconds;

  FrameAssembler(const FrameShape& shape, PacketOrder order);

  /// Adds a packet; pop() must have returned false before.
  void add(const Packet& packet);

  /// Takes the next frame that is complete or given up; false without one. Throws Error if the
  /// frame's buffer has another size.
  bool pop(StreamedFrame& frame);

  /// Time at which give_up() will give up the oldest frame under way.
  [[nodiscard]] std::optional<Time> deadline() const;

  /// Gives up all frames under way.
  void give_up();

  [[nodiscard]] const FrameShape& shape() const { return shape_; }
  /// Shape of the latest packet that is sound, but of other frames.
  [[nodiscard]] const std::optional<FrameShape>& other() const { return other_; }
  [[nodiscard]] StreamHealth health(Time now) const;
  void set_counts(const StreamHealth& counts) { counts_ = counts; }

 private:
  struct Slot {
    explicit Slot(const FrameShape& shape)
        : readings(shape.type, shape.rows, shape.cols), rows_came(shape.rows) {}

    FrameBuffer readings;
    std::vector<std::uint8_t> rows_came;
    PillarfieldPacket header = {};  ///< of its last packet
    std::uint32_t parts_left = 0;
    Time arrived{0};
    std::uint64_t order = 0;  ///< of delivery; 0: under way
    std::uint64_t epoch = 0;  ///< restarts before it
    bool used = false;
    bool first = false;  ///< may have begun before the stream listened
  };

  [[nodiscard]] bool began_anew(const PillarfieldPacket& header, Time arrived) const;
  void restart();
  void add_to_frame(const Packet& packet);
  void count_late(const PillarfieldPacket& header);
  Slot* slot_of(std::uint64_t sequence);
  Slot& new_slot(const PillarfieldPacket& header);
  void store(Slot& slot, const Packet& packet);
  void measure_interval(std::uint64_t sequence, Time arrived);
  void release(Slot& slot);
  void release_complete();
  void give_up_before(std::uint64_t sequence);
  void merge(Slot& slot, std::vector<SenselBlock>& missing);

  FrameShape shape_;
  std::optional<FrameShape> other_;
  std::uint64_t window_;
  std::vector<Slot> slots_;
  FrameBuffer latest_;  ///< readings of the last frame delivered
  PartHistory history_;
  Sessions sessions_;
  SensorClock clock_;
  mutable RateMeter rate_;
  StreamHealth counts_;

  std::optional<std::uint64_t> next_;  ///< the oldest frame neither delivered nor lost
  std::uint64_t highest_ = 0;          ///< sequence of this session
  std::uint64_t epoch_ = 0;
  std::uint64_t delivered_epoch_ = 0;
  bool listening_ = false;  ///< a frame began since construction
  bool ended_ = false;      ///< the sensor said so
  std::uint64_t released_ = 0;
  Time last_packet_{0};
  Time frame_began_{0};  ///< arrival of the first packet of `highest_`
  double interval_ns_ = 0;
};

}  // namespace pillarfield
