#include "streams/source/flexitac_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace pillarfield {
namespace {

constexpr std::size_t kLeastSpace = 1 << 16;
/// Time in which bytes come that had waited since before the source was opened, and were cut.
constexpr std::chrono::milliseconds kSettling(100);

PillarfieldPacket header_of(const FrameShape& shape, std::uint64_t sequence) {
  PillarfieldPacket header = {};
  header.magic = PILLARFIELD_PACKET_MAGIC;
  header.content = PILLARFIELD_FRAME;
  header.type = PILLARFIELD_U8;
  header.rows = shape.rows;
  header.cols = shape.cols;
  header.sequence = sequence;
  header.parts = 1;
  header.bytes = static_cast<std::uint32_t>(shape.bytes());
  return header;
}

}  // namespace

FlexitacParser::FlexitacParser(const FrameShape& shape)
    : shape_(shape),
      frame_bytes_(kMarkBytes + shape.bytes()),
      buffer_((kProof + 1) * frame_bytes_ + 2 * kLeastSpace),
      chains_(frame_bytes_) {}

std::span<std::byte> FlexitacParser::space() {
  if (buffer_.size() - (end_ - begin_) < kLeastSpace) {
    // The oldest frame held begins kProof frames before the last mark of the chain.
    const std::uint64_t before = std::min(looked_ - begin_, (kProof + 1) * frame_bytes_);
    const std::uint64_t kept = looked_ - before;
    std::memmove(buffer_.data(), &buffer_[kept - begin_], end_ - kept);
    begin_ = kept;
    std::erase_if(reads_, [&](const Read& read) { return read.end <= kept; });
  }
  return std::span(buffer_).subspan(end_ - begin_);
}

void FlexitacParser::commit(std::size_t bytes, std::chrono::nanoseconds arrived) {
  if (bytes == 0) return;
  if (!opened_) opened_ = arrived;
  end_ += bytes;
  reads_.push_back({end_, arrived});
}

bool FlexitacParser::next(Packet& packet) {
  while (ready_ == 0 && looked_ + kMarkBytes <= end_) look_at(looked_++);
  if (ready_ == 0) return false;
  take_frame(packet);
  return true;
}

void FlexitacParser::look_at(std::uint64_t place) {
  const bool mark = is_mark(&buffer_[place - begin_]);
  std::uint8_t& chain = chains_[place % frame_bytes_];
  if (!mark) {
    if (chain > 1) clean_since_ = place + 1;
    chain = 0;
    if (step_since_ && place == next_) lose_step(place);
    return;
  }
  chain = std::min<std::uint8_t>(chain + 1, kProof + 1);
  measure_spacing(place);
  if (!step_since_) {
    find_step(place, chain);
  } else if (place == next_) {
    next_ += frame_bytes_;
    ++held_;
    release(place);
  }
  last_mark_ = place;
  if (chain > 1) last_link_ = place;
}

void FlexitacParser::measure_spacing(std::uint64_t mark) {
  const std::uint64_t before = std::exchange(spacing_, mark - last_mark_.value_or(0));
  spacings_ = spacing_ == before ? spacings_ + 1 : 1;
}

/// Takes the chain of a mark, of `marks` marks, for that of the frames if there is no alternative.
void FlexitacParser::find_step(std::uint64_t mark, std::uint8_t marks) {
  if (marks < 2) return;
  const std::uint64_t before = mark - frame_bytes_;
  // Frames up to this mark, with the one in which the last chain ended.
  const std::uint64_t clean = (mark - clean_since_) / frame_bytes_ + 1;
  const bool is_alone = last_mark_ == before && clean > 1;
  const bool is_proven = last_link_ == before && clean > kProof && marks > kProof;
  if (!is_alone && !is_proven) return;
  held_ = std::min({marks - std::uint64_t{1}, clean, std::uint64_t{kProof}});
  step_since_ = mark;
  next_ = mark + frame_bytes_;
  release(mark);
}

/// Finds out which of the frames held may be taken.
void FlexitacParser::release(std::uint64_t mark) {
  // A chain of n marks began within the frame n frames ago.
  std::array<bool, kProof + 2> begun = {};
  for (std::uint64_t slot = 0; slot < frame_bytes_; ++slot) {
    if (slot != mark % frame_bytes_) begun[chains_[slot]] = true;
  }
  for (; ready_ < held_; ++ready_) {
    const std::uint64_t frames_ago = held_ - ready_;
    if (!begun[frames_ago]) continue;
    if (frames_ago < kProof) return;
    const std::uint64_t proof = kProof * frame_bytes_;
    const bool is_doubtful = clean_since_ + proof > mark || *step_since_ + 2 * proof >= mark;
    if (is_doubtful) return lose_step(mark);
  }
}

void FlexitacParser::lose_step(std::uint64_t place) {
  count_rubbish();
  clean_since_ = place + 1;
  step_since_.reset();
  held_ = ready_ = 0;
}

void FlexitacParser::count_rubbish() {
  if (has_settled_ && !std::exchange(in_rubbish_, true)) ++invalid_;
}

/// Takes the oldest frame held. Bytes that were skipped before it stand for the frames that they
/// would have been, and for one at least; those while the source settles do not count.
void FlexitacParser::take_frame(Packet& packet) {
  const std::uint64_t begin = next_ - (held_ + 1) * frame_bytes_;
  const std::uint64_t end = begin + frame_bytes_;
  if (const std::uint64_t skipped = begin - taken_; has_settled_ && skipped > 0) {
    count_rubbish();
    sequence_ += std::max<std::uint64_t>(1, (skipped + frame_bytes_ / 2) / frame_bytes_);
  }
  in_rubbish_ = false;
  taken_ = end;
  --held_;
  --ready_;
  packet.header = header_of(shape_, sequence_++);
  packet.bytes = std::span(buffer_).subspan(begin - begin_ + kMarkBytes, shape_.bytes());
  packet.arrived = std::ranges::lower_bound(reads_, end, {}, &Read::end)->arrived;
  has_settled_ = packet.arrived - *opened_ > kSettling;
}

void FlexitacParser::finish() {
  looked_ = clean_since_ = end_;
  if (taken_ < end_) count_rubbish();
  step_since_.reset();
  held_ = ready_ = 0;
  std::ranges::fill(chains_, std::uint8_t{0});
}

std::string FlexitacParser::complaint() const {
  constexpr std::uint64_t kMostFrames = 8;
  constexpr std::uint64_t kSameSpacings = 4;
  if (taken_ > 0 || looked_ < kMostFrames * frame_bytes_) return {};
  if (std::ranges::count(chains_, kProof + 1) > 1) {
    return "readings look like the marks of frames; press the skin, so that they change";
  }
  if (spacings_ >= kSameSpacings && spacing_ != frame_bytes_) {
    return fmt::format("frames have {} readings, {} x {} expected", spacing_ - kMarkBytes,
                       shape_.rows, shape_.cols);
  }
  return fmt::format("bytes come, but no frames of {} x {}; check rows, columns and baud rate",
                     shape_.rows, shape_.cols);
}

}  // namespace pillarfield
