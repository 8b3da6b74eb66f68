#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pillarfield {

/// Remembers which parts of the latest frames came.
class PartHistory {
 public:
  explicit PartHistory(std::uint32_t most_parts);

  /// Notes a part; false if it came before, or its frame is too old to tell.
  bool add(std::uint64_t sequence, std::uint32_t part);

  /// Whether add() can tell.
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

}  // namespace pillarfield
