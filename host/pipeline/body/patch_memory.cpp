#include "pipeline/body/patch_memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "streams/source/restart_limits.h"

namespace pillarfield {
namespace {

/// Whether bytes that are replaced differ.
bool replace(std::byte* to, const std::byte* from, std::size_t bytes) {
  if (bytes == sizeof(std::uint64_t)) {  // Most rows: 8 readings of 8 bits.
    std::uint64_t before = 0;
    std::uint64_t after = 0;
    std::memcpy(&before, to, sizeof before);
    std::memcpy(&after, from, sizeof after);
    std::memcpy(to, from, sizeof after);
    return before != after;
  }
  const bool differs = std::memcmp(to, from, bytes) != 0;
  std::memcpy(to, from, bytes);
  return differs;
}

}  // namespace

PatchMemory::PatchMemory(const Skin& skin, SenselType type, double refresh_s,
                         std::span<std::byte> readings)
    : shape_{type, skin.rows, skin.cols},
      refresh_(std::llround(1e9 * refresh_s)),
      readings_(readings) {
  changed_.reserve(shape_.blocks());
}

void PatchMemory::add(const Packet& packet) {
  const PillarfieldPacket& header = packet.header;
  if (content_of(header) == PILLARFIELD_END) {
    ended_ = true;
    return;
  }
  if (!follow_sequence(header, packet.arrived)) {
    ++health_.late;
    return;
  }
  ended_ = false;
  ++health_.packets;
  received_ = true;
  arrived_ = packet.arrived;
  if (header.time_ns != 0) {
    device_time_ns_ = header.time_ns;
    clock_.add(header.time_ns, packet.arrived);
  }
  switch (content_of(header)) {
    case PILLARFIELD_FRAME:
      return store_rows(packet, 0, shape_.rows);
    case PILLARFIELD_ROWS:
      return store_rows(packet, header.first, header.count);
    default:
      return store_blocks(packet);
  }
}

bool PatchMemory::follow_sequence(const PillarfieldPacket& header, Time arrived) {
  const auto session = sessions_.classify(header.session, arrived);
  if (session == Sessions::Kind::replaced) return false;
  const std::uint64_t ahead = header.sequence - sequence_;
  const std::uint64_t back = sequence_ - header.sequence;
  const bool is_ahead = ahead <= kFarAhead;
  const bool is_back = arrived - arrived_ > kLongestGap || back > kFarBack ||
                       (header.sequence < kNearZero && back > kFewFrames);
  const bool began_anew = ended_ || (!is_ahead && is_back);
  if (!began_ || session == Sessions::Kind::started || began_anew) {
    if (began_) ++health_.restarts;
    began_ = true;
    whole_since_ = arrived;
  } else if (!is_ahead) {
    return false;
  } else if (ahead > 0) {
    // Of frames that did not come at all one packet is counted: how many they had is unknown.
    if (parts_left_ + ahead > 1) count_lost(parts_left_ + ahead - 1, arrived);
  } else {
    if (header.part >= came_.size() || came_[header.part]) return false;
    came_[header.part] = true;
    --parts_left_;
    return true;
  }
  sequence_ = header.sequence;
  parts_left_ = header.parts - 1;
  came_.assign(header.parts, false);
  came_[header.part] = true;
  return true;
}

void PatchMemory::count_lost(std::uint64_t packets, Time arrived) {
  health_.lost += packets;
  whole_since_ = arrived;
}

void PatchMemory::store_rows(const Packet& packet, std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kRows = PILLARFIELD_BLOCK_SIDE;
  constexpr std::uint32_t kCols = 64;  // A cache line of 8 bits: few comparisons.
  const std::byte* const from = packet.bytes.data();
  for (std::uint32_t row = 0; row < count; row += kRows) {
    for (std::uint32_t col = 0; col < shape_.cols; col += kCols) {
      store({first + row, std::min(kRows, count - row), col, std::min(kCols, shape_.cols - col)},
            from + row * shape_.row_bytes() + col * size_of(shape_.type), shape_.row_bytes());
    }
  }
}

void PatchMemory::store_blocks(const Packet& packet) {
  const std::size_t row_bytes = size_of(shape_.type) * PILLARFIELD_BLOCK_SIDE;
  for (std::uint32_t i = 0; i < packet.header.count; ++i) {
    const std::byte* const block = &packet.bytes[i * shape_.block_bytes()];
    store(sensels_of_block(shape_, block_number(block)), block + kBlockHead, row_bytes);
  }
  health_.blocks += packet.header.count;
}

/// Refreshed blocks mostly have the readings that they had: comparing costs less than solving.
void PatchMemory::store(const SenselBlock& place, const std::byte* from, std::size_t from_stride) {
  const std::size_t size = size_of(shape_.type);
  const std::size_t bytes = place.cols * size;
  std::byte* to = &readings_[place.first_row * shape_.row_bytes() + place.first_col * size];
  bool differs = false;
  for (std::uint32_t row = 0; row < place.rows; ++row) {
    differs = replace(to, from, bytes) || differs;
    from += from_stride;
    to += shape_.row_bytes();
  }
  if (!differs) return;
  ++health_.changed;
  // Where nobody solves, the list stays as short as the skin has blocks.
  if (changed_.size() == changed_.capacity()) changed_.assign({{0, shape_.rows, 0, shape_.cols}});
  changed_.push_back(place);
}

void PatchMemory::describe(PatchState& state) const {
  state.health = health_;
  state.sequence = sequence_;
  state.device_time_ns = device_time_ns_;
  state.host_time = device_time_ns_ != 0 ? clock_.host_time(device_time_ns_) : arrived_;
  state.stale = !began_ || arrived_ - whole_since_ < refresh_;
}

}  // namespace pillarfield
