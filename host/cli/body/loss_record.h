#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "streams/source/packet.h"

namespace pillarfield::cli {

/// The blocks of a patch whose readings are old because a packet was lost, until they come again.
class LossRecord {
 public:
  explicit LossRecord(const FrameShape& shape) : shape_(shape), since_(shape.blocks()) {}

  /// A packet of blocks was lost at the time `frame`, above 0; `received`: the receiver's readings.
  void lose(std::span<const std::byte> blocks, const FrameView& received, std::uint64_t frame);
  /// A packet of blocks came.
  void heal(std::span<const std::byte> blocks, std::uint64_t frame);

  [[nodiscard]] std::uint64_t lost() const { return lost_; }  ///< blocks that became old
  [[nodiscard]] std::uint64_t old_now() const { return old_; }
  /// The longest time in frames that a block was old.
  [[nodiscard]] std::uint64_t longest(std::uint64_t now) const;

 private:
  FrameShape shape_;
  std::vector<std::uint64_t> since_;  ///< frame of each block's first loss; 0: not old
  std::uint64_t lost_ = 0;
  std::uint64_t old_ = 0;
  std::uint64_t longest_ = 0;
};

}  // namespace pillarfield::cli
