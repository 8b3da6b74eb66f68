#include "streams/source/part_history.h"

#include <algorithm>

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

}  // namespace pillarfield
