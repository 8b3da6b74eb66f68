#pragma once

#include <functional>

#include "viewer/source/field_producer.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"

namespace pillarfield::viewer {

/// Shows the true forces of a simulation.
class TruthProducer final : public FieldProducer {
 public:
  /// Overwrites the forces of frame `index` and returns its time, s.
  using Reader = std::function<double(std::uint64_t index, ForceField& truth)>;

  /// `solved` describes the frames; its name and what depends on solving are replaced.
  TruthProducer(const SourceInfo& solved, Reader read);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;

 private:
  SourceInfo info_;
  Reader read_;
  ForceField truth_;  ///< read last
  ObjectPool<PlaneBlock> blocks_;
};

}  // namespace pillarfield::viewer
