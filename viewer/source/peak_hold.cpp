#include "viewer/source/peak_hold.h"

#include <algorithm>

#include "pillarfield/status.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

void PeakHold::add(const ForceFieldView& forces) {
  if (peaks_.size() != forces.normal.size()) peaks_.assign(forces.normal.size(), 0);
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const float normal = forces.normal[i];
    if (normal > peaks_[i] && normal <= std::numeric_limits<float>::max()) peaks_[i] = normal;
  }
}

std::shared_ptr<const ShownField> PeakHold::field(const ShownField& frame) {
  if (!blocks_) {
    const std::uint32_t rows = frame.forces.rows;
    const std::uint32_t cols = frame.forces.cols;
    blocks_.emplace(FieldProducer::kMostShown,
                    [=] { return std::make_unique<PlaneBlock>(rows, cols, false); });
  }
  const std::shared_ptr<PlaneBlock> block = blocks_->acquire();
  if (block == nullptr) return nullptr;
  std::ranges::copy(peaks_, block->plane(PlaneBlock::kNormal).begin());
  std::ranges::copy(peaks_, block->plane(PlaneBlock::kMagnitude).begin());
  std::ranges::transform(peaks_, block->status().begin(),
                         [](float peak) { return peak > 0 ? status::kUsable : 0; });
  auto field = std::make_shared<ShownField>(frame);
  field->forces = block->view();
  field->raw = {};
  field->pages = block->pages();
  field->keep_alive = block;
  field->contacts = frame.contacts;
  return field;
}

}  // namespace pillarfield::viewer
