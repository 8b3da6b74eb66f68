#pragma once

#include <cstddef>
#include <vector>

#include "pillarfield/force_sink.h"
#include "pillarfield/live.h"

namespace pillarfield {

/// The parts of a solved frame that a sink needs.
struct FrameParts {
  bool forces = false;      ///< shear_x, shear_y, normal and status
  bool all_planes = false;  ///< with `forces`: angles and uncertainty as well, where solved
  bool contacts = false;
  bool readings = false;

  [[nodiscard]] bool any() const { return forces || contacts || readings; }
};

/// Bytes of these parts of a frame.
[[nodiscard]] std::size_t bytes_of(const SolvedFrame& frame, const FrameParts& parts);

/// A solved frame that owns its memory, which the next frame reuses.
class FrameCopy {
 public:
  FrameCopy() = default;
  FrameCopy(const FrameCopy&) = delete;  // frame() refers to members
  FrameCopy& operator=(const FrameCopy&) = delete;

  /// Copies parts of a frame; the other parts become empty.
  void assign(const SolvedFrame& frame, const FrameParts& parts);

  /// Bytes of memory that it holds, and their release; frame() is empty then.
  [[nodiscard]] std::size_t capacity() const;
  void release();

  /// A view of the copy, valid until the next assign().
  [[nodiscard]] const SolvedFrame& frame() const { return frame_; }

 private:
  void copy_forces(const ForceFieldView& forces, bool all_planes);
  void copy_readings(const FrameView& readings);

  SolvedFrame frame_;
  std::vector<std::vector<float>> planes_;
  std::vector<std::uint8_t> status_;
  FrameContacts contacts_;
  std::vector<std::byte> readings_;
  std::vector<SenselBlock> missing_;
};

}  // namespace pillarfield
