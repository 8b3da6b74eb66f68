#include "pipeline/body/block_sender.h"

#include <algorithm>
#include <cstring>

#include "solve/activation_thresholds.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

/// A threshold of each sensel; none if forces depend on smaller readings too.
std::vector<float> thresholds_of(const SolverPlan& plan) {
  if (!may_solve_changes(plan)) return {};
  std::vector<float> thresholds = activation_thresholds(plan);
  if (thresholds.size() == 1) thresholds.assign(plan.skin.sensels(), thresholds.front());
  return thresholds;
}

/// Whether readings that became others may change a force; NaN may. Without branches, which idle
/// sensels with noise would mispredict.
template <class Reading>
bool any_matters(const Reading* before, const Reading* after, const float* thresholds,
                 std::uint32_t count) {
  bool any = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto is_idle = [limit = thresholds[i]](Reading value) {
      const auto reading = static_cast<float>(value);
      return (reading < limit) & (reading >= -static_cast<float>(kMaxCounts));
    };
    any |= (before[i] != after[i]) & !(is_idle(before[i]) & is_idle(after[i]));
  }
  return any;
}

template <class Reading>
bool any_matters(const FrameShape& shape, const SenselBlock& place, const FrameBuffer& before,
                 const FrameBuffer& after, const std::vector<float>& thresholds) {
  const Reading* const old = before.readings<Reading>().data();
  const Reading* const now = after.readings<Reading>().data();
  for (std::uint32_t row = 0; row < place.rows; ++row) {
    const std::size_t at = std::size_t{place.first_row + row} * shape.cols + place.first_col;
    if (std::memcmp(old + at, now + at, place.cols * sizeof(Reading)) == 0) continue;
    if (thresholds.empty() || any_matters(old + at, now + at, &thresholds[at], place.cols)) {
      return true;
    }
  }
  return false;
}

}  // namespace

BlockSender::BlockSender(const SolverPlan& plan, std::uint32_t patch, std::uint64_t refresh_frames)
    : shape_{plan.sensel_type, plan.skin.rows, plan.skin.cols},
      patch_(patch),
      refresh_frames_(std::max<std::uint64_t>(refresh_frames, 1)),
      thresholds_(thresholds_of(plan)),
      last_(plan.sensel_type, plan.skin.rows, plan.skin.cols) {}

bool BlockSender::has_changed(const FrameBuffer& frame, std::uint32_t block) const {
  const SenselBlock place = sensels_of_block(shape_, block);
  switch (shape_.type) {
    case SenselType::u8:
      return any_matters<std::uint8_t>(shape_, place, last_, frame, thresholds_);
    case SenselType::u16:
      return any_matters<std::uint16_t>(shape_, place, last_, frame, thresholds_);
    default:
      return any_matters<float>(shape_, place, last_, frame, thresholds_);
  }
}

void BlockSender::copy_block(const FrameBuffer& frame, std::uint32_t block,
                             std::vector<std::byte>& to) {
  const SenselBlock place = sensels_of_block(shape_, block);
  const std::size_t size = size_of(shape_.type);
  const std::size_t begin = to.size();
  to.resize(begin + shape_.block_bytes());
  std::memcpy(&to[begin], &block, sizeof block);
  for (std::uint32_t row = 0; row < place.rows; ++row) {
    const std::size_t at = (place.first_row + row) * shape_.row_bytes() + place.first_col * size;
    std::memcpy(&to[begin + kBlockHead + row * size * PILLARFIELD_BLOCK_SIDE], &frame.bytes()[at],
                place.cols * size);
    std::memcpy(&last_.bytes()[at], &frame.bytes()[at], place.cols * size);
  }
}

void BlockSender::send(const FrameBuffer& frame, std::uint64_t sequence, std::uint64_t time_ns,
                       const Send& send) {
  const std::uint64_t blocks = shape_.blocks();
  const std::uint64_t turn = sequence % refresh_frames_;
  const std::uint64_t first_due = turn * blocks / refresh_frames_;
  const std::uint64_t end_due = (turn + 1) * blocks / refresh_frames_;
  numbers_.clear();
  changed_ = 0;
  for (std::uint32_t block = 0; block < blocks; ++block) {
    const bool changed = has_changed(frame, block);
    if (changed) ++changed_;
    if (changed || (block >= first_due && block < end_due)) numbers_.push_back(block);
  }
  const std::size_t in_packet =
      std::max<std::size_t>((kPacketBytes - sizeof(PillarfieldPacket)) / shape_.block_bytes(), 1);
  const auto parts = static_cast<std::uint32_t>(
      std::max<std::size_t>((numbers_.size() + in_packet - 1) / in_packet, 1));
  for (std::uint32_t part = 0; part < parts; ++part) {
    const std::size_t first = part * in_packet;
    const std::size_t end = std::min(first + in_packet, numbers_.size());
    bytes_.clear();
    for (std::size_t i = first; i < end; ++i) copy_block(frame, numbers_[i], bytes_);
    PillarfieldPacket header = {};
    header.magic = PILLARFIELD_PACKET_MAGIC;
    header.content = PILLARFIELD_BLOCKS;
    header.type = static_cast<std::uint16_t>(static_cast<int>(shape_.type) + PILLARFIELD_U8);
    header.rows = shape_.rows;
    header.cols = shape_.cols;
    header.session = 1;
    header.sequence = sequence;
    header.time_ns = time_ns;
    header.part = part;
    header.parts = parts;
    header.count = static_cast<std::uint32_t>(end - first);
    header.patch = patch_;
    header.bytes = static_cast<std::uint32_t>(bytes_.size());
    send(header, bytes_);
  }
}

}  // namespace pillarfield
