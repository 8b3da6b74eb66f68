#include "cli/body/loss_record.h"

#include <algorithm>
#include <cstring>

namespace pillarfield::cli {
namespace {

bool differs(const FrameShape& shape, std::uint32_t number, const std::byte* readings,
             const FrameView& received) {
  const SenselBlock place = sensels_of_block(shape, number);
  const std::size_t size = size_of(shape.type);
  const auto* const frame = static_cast<const std::byte*>(received.data);
  for (std::uint32_t row = 0; row < place.rows; ++row) {
    const std::size_t at = (place.first_row + row) * shape.row_bytes() + place.first_col * size;
    const std::byte* const from = readings + row * size * PILLARFIELD_BLOCK_SIDE;
    if (std::memcmp(frame + at, from, place.cols * size) != 0) return true;
  }
  return false;
}

}  // namespace

void LossRecord::lose(std::span<const std::byte> blocks, const FrameView& received,
                      std::uint64_t frame) {
  for (std::size_t at = 0; at < blocks.size(); at += shape_.block_bytes()) {
    const std::uint32_t number = block_number(&blocks[at]);
    if (since_[number] != 0 || !differs(shape_, number, &blocks[at + kBlockHead], received))
      continue;
    since_[number] = frame;
    ++lost_;
    ++old_;
  }
}

void LossRecord::heal(std::span<const std::byte> blocks, std::uint64_t frame) {
  for (std::size_t at = 0; at < blocks.size(); at += shape_.block_bytes()) {
    std::uint64_t& since = since_[block_number(&blocks[at])];
    if (since == 0) continue;
    longest_ = std::max(longest_, frame - since);
    since = 0;
    --old_;
  }
}

std::uint64_t LossRecord::longest(std::uint64_t now) const {
  std::uint64_t longest = longest_;
  for (const std::uint64_t since : since_) {
    if (since != 0) longest = std::max(longest, now - since);
  }
  return longest;
}

}  // namespace pillarfield::cli
