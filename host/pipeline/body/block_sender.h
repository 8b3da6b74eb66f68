#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "streams/source/packet.h"

namespace pillarfield {

/// The sender of a patch: packets of the blocks that changed, and of those whose turn it is to be
/// refreshed. Readings below the activation threshold change no force, and are sent only with
/// others: forces from the packets have the bits of those from whole frames.
class BlockSender {
 public:
  /// Most bytes of a packet, so that a datagram is not split on networks.
  static constexpr std::size_t kPacketBytes = 1400;

  /// `refresh_frames`: frames in which every block is sent at least once.
  BlockSender(const SolverPlan& plan, std::uint32_t patch, std::uint64_t refresh_frames);

  using Send = std::function<void(const PillarfieldPacket& header, std::span<const std::byte>)>;

  /// Sends a frame of dense rows.
  void send(const FrameBuffer& frame, std::uint64_t sequence, std::uint64_t time_ns,
            const Send& send);

  /// Blocks of the frame sent last that changed, and in all.
  [[nodiscard]] std::size_t changed() const { return changed_; }
  [[nodiscard]] std::size_t sent() const { return numbers_.size(); }
  [[nodiscard]] std::size_t blocks() const { return shape_.blocks(); }

 private:
  [[nodiscard]] bool has_changed(const FrameBuffer& frame, std::uint32_t block) const;
  void copy_block(const FrameBuffer& frame, std::uint32_t block, std::vector<std::byte>& to);

  FrameShape shape_;
  std::uint32_t patch_;
  std::uint64_t refresh_frames_;
  std::vector<float> thresholds_;  ///< of each sensel; empty: every change is sent
  FrameBuffer last_;               ///< readings sent last
  std::vector<std::uint32_t> numbers_;
  std::vector<std::byte> bytes_;
  std::size_t changed_ = 0;
};

}  // namespace pillarfield
