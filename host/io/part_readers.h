#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

#include "pillarfield/force_file.h"
#include "pillarfield/force_parts.h"

namespace pillarfield {

/// The parts of a joined file. The names of their files follow from its own, so that a file from
/// elsewhere leads to no other folder. Each part is probed and checked when it is opened.
class PartReaders {
 public:
  /// `joined` holds what all parts have in common; `info` their size.
  PartReaders(std::filesystem::path folder, ForcePart joined, const ForceFileInfo& info,
              ReadOptions options);

  [[nodiscard]] std::uint64_t parts() const { return joined_.count; }
  [[nodiscard]] const std::vector<LostPart>& lost() const { return lost_; }

  /// Opens all parts and returns those that cannot be used.
  [[nodiscard]] std::vector<LostPart> examine(const StepProgress& progress) const;

  /// Reads the planes of a frame; NaN and status::kInconsistent if its part is absent.
  void read(std::uint64_t frame, ForceField& forces);

 private:
  [[nodiscard]] ForcePart part(std::uint64_t index) const;
  [[nodiscard]] std::filesystem::path file(std::uint64_t index) const;
  [[nodiscard]] ForceFileReader open(std::uint64_t index) const;
  [[nodiscard]] const ForceFileReader& reader(std::uint64_t index);
  void fill(ForceField& forces) const;

  std::filesystem::path folder_;
  ForcePart joined_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  bool uncertainty_;
  ReadOptions options_;
  std::vector<std::uint64_t> ends_;  ///< of the frames of each part
  std::vector<bool> is_lost_;
  std::vector<LostPart> lost_;
  std::deque<std::pair<std::uint64_t, ForceFileReader>> open_;  ///< the latest last
};

}  // namespace pillarfield
