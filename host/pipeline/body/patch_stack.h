#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pillarfield/processor.h"
#include "pillarfield/whole_body.h"

namespace pillarfield {

/// Patches that one launch solves: one below the other in one frame, with a pillar row of zeros
/// between them. They have one width and one program; other patches are alone.
class PatchStack {
 public:
  /// The patches `members` of a skin.
  PatchStack(const Device& device, const BodySkin& skin, std::vector<std::size_t> members);

  /// Indices of the patches of each stack.
  [[nodiscard]] static std::vector<std::vector<std::size_t>> divide(const Device& device,
                                                                    const BodySkin& skin);

  [[nodiscard]] const std::vector<std::size_t>& members() const { return members_; }

  /// The readings of a member; `at` counts the members.
  [[nodiscard]] std::span<std::byte> readings(std::size_t at);

  /// Sensels of a member changed.
  void mark(std::size_t at, std::span<const SenselBlock> changed);

  /// Starts to solve what was marked; false if nothing was. Everything is marked at first, and
  /// where a stage needs all readings of each frame whenever a packet was `received`.
  bool submit(bool received);
  /// Waits for it.
  void receive() { forces_ = processor_.receive(); }
  /// The forces of a member after receive().
  [[nodiscard]] ForceFieldView forces(std::size_t at) const;
  [[nodiscard]] bool solves_all() const { return solves_all_ || !solved_; }

 private:
  struct Place {
    std::uint32_t first_row;  ///< sensels
    std::uint32_t rows;
  };

  std::vector<std::size_t> members_;
  std::vector<Place> places_;
  std::size_t row_bytes_ = 0;
  bool solves_all_;
  bool solved_ = false;
  FrameBuffer frame_;
  std::vector<SenselBlock> changed_;
  Processor processor_;
  ForceFieldView forces_;
};

}  // namespace pillarfield
