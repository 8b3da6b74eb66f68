#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/whole_body.h"
#include "pipeline/body/patch_clock.h"
#include "streams/source/packet.h"
#include "streams/source/sessions.h"

namespace pillarfield {

/// The readings of a patch as its packets bring them, and what is known of losses.
///
/// A packet of a frame before the newest is not used: its blocks may have come since. A gap in the
/// sequence, or fewer parts than announced, are lost packets; their blocks keep their readings
/// until they are sent again.
class PatchMemory {
 public:
  using Time = std::chrono::nanoseconds;

  /// `readings`: dense rows, which outlive this object.
  PatchMemory(const Skin& skin, SenselType type, double refresh_s, std::span<std::byte> readings);

  /// Takes a packet that is intact and of this shape.
  void add(const Packet& packet);

  [[nodiscard]] const FrameShape& shape() const { return shape_; }
  [[nodiscard]] FrameView readings() const {
    return {readings_.data(), shape_.type, shape_.rows, shape_.cols, shape_.cols};
  }
  /// Sensels whose readings changed since forget_changes().
  [[nodiscard]] std::span<const SenselBlock> changed() const { return changed_; }
  /// Whether a packet came since forget_changes().
  [[nodiscard]] bool received() const { return received_; }
  void forget_changes() {
    changed_.clear();
    received_ = false;
  }

  /// Sets all of `state` but forces and load.
  void describe(PatchState& state) const;

 private:
  /// False if the packet is late.
  bool follow_sequence(const PillarfieldPacket& header, Time arrived);
  void count_lost(std::uint64_t packets, Time arrived);
  void store_rows(const Packet& packet, std::uint32_t first, std::uint32_t count);
  void store_blocks(const Packet& packet);
  void store(const SenselBlock& place, const std::byte* from, std::size_t from_stride);

  FrameShape shape_;
  Time refresh_;
  std::span<std::byte> readings_;
  std::vector<SenselBlock> changed_;
  Sessions sessions_;
  PatchClock clock_;
  PatchHealth health_;
  bool began_ = false;
  bool ended_ = false;  ///< the sensor said so after its last packet
  std::uint64_t sequence_ = 0;
  std::uint32_t parts_left_ = 0;  ///< of the newest frame
  std::vector<bool> came_;        ///< its parts
  bool received_ = false;
  std::uint64_t device_time_ns_ = 0;
  Time arrived_{0};
  Time whole_since_{0};  ///< nothing was lost from then on
};

}  // namespace pillarfield
