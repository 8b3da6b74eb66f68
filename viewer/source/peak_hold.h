#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// The largest normal force of each pillar over the frames since it began.
class PeakHold {
 public:
  /// Forces that are not finite count as zero.
  void add(const ForceFieldView& forces);

  /// Forgets all frames.
  void reset() { peaks_.clear(); }

  /// A field with the peaks as normal force and no shear; its other members are those of `frame`,
  /// which has the size of the frames so far. Null where all its memory is in use.
  [[nodiscard]] std::shared_ptr<const ShownField> field(const ShownField& frame);

 private:
  std::vector<float> peaks_;
  std::optional<ObjectPool<PlaneBlock>> blocks_;
};

}  // namespace pillarfield::viewer
