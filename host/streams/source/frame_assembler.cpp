#include "streams/source/frame_assembler.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "pillarfield/error.h"
#include "streams/source/sessions.h"

namespace pillarfield {

PartHistory::PartHistory(std::uint32_t most_parts) {
  for (Frame& frame : frames_) frame.parts.assign(most_parts / 64 + 1, 0);
}

bool PartHistory::reaches(std::uint64_t sequence) const {
  const Frame& frame = frames_[sequence % kFrames];
  return !frame.known || frame.sequence <= sequence;
}

bool PartHistory::add(std::uint64_t sequence, std::uint32_t part) {
  if (!reaches(sequence)) return false;
  Frame& frame = frames_[sequence % kFrames];
  if (!frame.known || frame.sequence != sequence) {
    std::fill_n(frame.parts.begin(), frame.words, 0);
    frame.sequence = sequence;
    frame.known = true;
    frame.words = 0;
  }
  frame.words = std::max(frame.words, part / 64 + 1);
  const std::uint64_t bit = std::uint64_t{1} << part % 64;
  std::uint64_t& word = frame.parts[part / 64];
  const bool is_new = (word & bit) == 0;
  word |= bit;
  return is_new;
}

void PartHistory::clear() {
  for (Frame& frame : frames_) frame.known = false;
}

namespace {

using namespace std::chrono_literals;

}  // namespace

FrameAssembler::FrameAssembler(const FrameShape& shape, PacketOrder order)
    : shape_(shape),
      window_(static_cast<std::uint64_t>(order)),
      latest_(shape.type, shape.rows, shape.cols),
      history_(PILLARFIELD_MAX_PARTS) {
  // add() may release all frames under way and begin another one.
  for (std::uint64_t i = 0; i <= window_; ++i) slots_.emplace_back(shape);
}

void FrameAssembler::add(const Packet& packet) {
  const PillarfieldPacket& header = packet.header;
  const bool is_last_number = header.sequence == std::numeric_limits<std::uint64_t>::max();
  const auto shape = shape_of(header);
  const bool intact = shape && is_intact(packet);
  if (is_last_number || !intact || shape != shape_) {
    if (intact && shape != shape_) other_ = shape;
    ++counts_.invalid;
    return;
  }
  if (content_of(header) == PILLARFIELD_CONSTANTS) return;
  const Sessions::Kind session = sessions_.classify(header.session, packet.arrived);
  if (session == Sessions::Kind::replaced) {
    ++counts_.late;
    return;
  }
  if (session == Sessions::Kind::started) restart();
  if (content_of(header) == PILLARFIELD_END) {
    give_up();
    ended_ = true;
    return;
  }
  if (began_anew(header, packet.arrived)) restart();
  ended_ = false;
  last_packet_ = packet.arrived;
  if (header.sequence < next_.value_or(0)) {
    count_late(header);
  } else {
    add_to_frame(packet);
  }
}

bool FrameAssembler::began_anew(const PillarfieldPacket& header, Time arrived) const {
  const std::uint64_t expected = next_.value_or(0);
  const std::uint64_t sequence = header.sequence;
  if (sequence >= expected) return next_ && sequence - expected > kFarAhead;
  const std::uint64_t back = expected - sequence;
  const Time longest_gap = std::max<Time>(kLongestGap, Time(std::llround(4 * interval_ns_)));
  return ended_ || back > kFarBack || (sequence < kNearZero && back > kFewFrames) ||
         arrived - last_packet_ > longest_gap;
}

/// Ends the frames from before the sensor started again.
void FrameAssembler::restart() {
  give_up();
  next_.reset();
  highest_ = 0;
  history_.clear();
  ++epoch_;
  ++counts_.restarts;
}

void FrameAssembler::count_late(const PillarfieldPacket& header) {
  const bool remembered = history_.reaches(header.sequence);
  const bool is_new = history_.add(header.sequence, header.part);
  ++(remembered && !is_new ? counts_.duplicates : counts_.late);
}

void FrameAssembler::add_to_frame(const Packet& packet) {
  const PillarfieldPacket& header = packet.header;
  const std::uint64_t sequence = header.sequence;
  if (!next_) {
    next_ = highest_ = sequence;
    frame_began_ = packet.arrived;
  }
  if (sequence - *next_ >= window_) give_up_before(sequence - (window_ - 1));
  Slot* const known = slot_of(sequence);
  Slot& slot = known != nullptr ? *known : new_slot(header);
  if (slot.header.parts != header.parts || slot.header.content != header.content) {
    ++counts_.invalid;
    return;
  }
  if (!history_.add(sequence, header.part)) {
    ++counts_.duplicates;
    return;
  }
  if (sequence < highest_) ++counts_.reordered;
  if (sequence > highest_) measure_interval(sequence, packet.arrived);
  store(slot, packet);
  release_complete();
}

FrameAssembler::Slot* FrameAssembler::slot_of(std::uint64_t sequence) {
  const auto found = std::ranges::find_if(slots_, [&](const Slot& slot) {
    return slot.used && slot.order == 0 && slot.header.sequence == sequence;
  });
  return found == slots_.end() ? nullptr : &*found;
}

FrameAssembler::Slot& FrameAssembler::new_slot(const PillarfieldPacket& header) {
  const auto found = std::ranges::find_if(slots_, [](const Slot& slot) { return !slot.used; });
  if (found == slots_.end()) throw Error("stream", "frames were not taken", "call pop()");
  std::ranges::fill(found->rows_came, std::uint8_t{0});
  found->header = header;
  found->parts_left = header.parts;
  found->order = 0;
  found->epoch = epoch_;
  found->first = !std::exchange(listening_, true);
  found->used = true;
  return *found;
}

void FrameAssembler::store(Slot& slot, const Packet& packet) {
  const PillarfieldPacket& header = packet.header;
  const bool rows = content_of(header) == PILLARFIELD_ROWS;
  const std::size_t first = rows ? header.first : 0;
  const std::size_t count = rows ? header.count : shape_.rows;
  --slot.parts_left;
  slot.arrived = packet.arrived;
  std::memcpy(&slot.readings.bytes()[first * shape_.row_bytes()], packet.bytes.data(),
              count * shape_.row_bytes());
  std::fill_n(slot.rows_came.begin() + static_cast<std::ptrdiff_t>(first), count, std::uint8_t{1});
}

void FrameAssembler::measure_interval(std::uint64_t sequence, Time arrived) {
  const auto frames = static_cast<double>(sequence - highest_);
  const double interval_ns =
      std::max(static_cast<double>((arrived - frame_began_).count()), 1.0) / frames;
  interval_ns_ += (interval_ns - interval_ns_) * (interval_ns_ == 0 ? 1 : 1.0 / 16);
  frame_began_ = arrived;
  highest_ = sequence;
}

void FrameAssembler::release(Slot& slot) {
  if (slot.first && slot.parts_left > 0) {
    slot.used = false;
  } else {
    slot.order = ++released_;
  }
}

void FrameAssembler::release_complete() {
  for (Slot* slot = slot_of(*next_); slot != nullptr && slot->parts_left == 0;
       slot = slot_of(*next_)) {
    release(*slot);
    ++*next_;
  }
}

void FrameAssembler::give_up_before(std::uint64_t sequence) {
  std::uint64_t lost = sequence - *next_;
  for (std::uint64_t each = *next_; each < sequence && each - *next_ < window_; ++each) {
    Slot* const slot = slot_of(each);
    if (slot == nullptr) continue;
    release(*slot);
    --lost;
  }
  counts_.lost += lost;
  next_ = sequence;
}

void FrameAssembler::give_up() {
  if (next_ && *next_ <= highest_) give_up_before(highest_ + 1);
}

std::optional<FrameAssembler::Time> FrameAssembler::deadline() const {
  const bool under_way =
      std::ranges::any_of(slots_, [](const Slot& slot) { return slot.used && slot.order == 0; });
  if (!under_way) return std::nullopt;
  const Time two_intervals(std::llround(std::min(2 * interval_ns_, 1e9)));
  // A stream that goes on gives frames up without the deadline.
  return last_packet_ + std::max<Time>(two_intervals, interval_ns_ == 0 ? 100ms : 20ms);
}

bool FrameAssembler::pop(StreamedFrame& frame) {
  Slot* slot = nullptr;
  for (Slot& each : slots_) {
    if (each.used && each.order > 0 && (slot == nullptr || each.order < slot->order)) slot = &each;
  }
  if (slot == nullptr) return false;
  if (frame.buffer.bytes().size() != shape_.bytes()) {
    throw Error("stream", "the buffer of a frame has another size", "construct it for the stream");
  }
  frame.missing.reserve(shape_.rows / 2 + 1);
  frame.missing.clear();
  merge(*slot, frame.missing);
  std::ranges::copy(latest_.bytes(), frame.buffer.bytes().begin());
  frame.readings = frame.buffer.view();
  frame.sequence = slot->header.sequence;
  frame.arrived = slot->arrived;
  const bool restarted = std::exchange(delivered_epoch_, slot->epoch) != slot->epoch;
  frame.time_s = clock_.seconds(slot->header.time_ns, slot->arrived, restarted);
  ++counts_.frames;
  if (slot->parts_left > 0 || !frame.missing.empty()) ++counts_.incomplete;
  rate_.count(slot->arrived);
  slot->used = false;
  return true;
}

/// Brings `latest_` up to date.
void FrameAssembler::merge(Slot& slot, std::vector<SenselBlock>& missing) {
  if (content_of(slot.header) == PILLARFIELD_FRAME) return std::swap(latest_, slot.readings);
  for (std::uint32_t row = 0; row < shape_.rows; ++row) {
    if (slot.rows_came[row] != 0) {
      const std::size_t start = row * shape_.row_bytes();
      std::memcpy(&latest_.bytes()[start], &slot.readings.bytes()[start], shape_.row_bytes());
    } else if (row > 0 && slot.rows_came[row - 1] == 0) {
      ++missing.back().rows;
    } else {
      missing.push_back({row, 1, 0, shape_.cols});
    }
  }
}

StreamHealth FrameAssembler::health(Time now) const {
  StreamHealth health = counts_;
  health.clock_jumps = clock_.jumps();
  health.rate_hz = rate_.rate_hz(now);
  return health;
}

}  // namespace pillarfield
