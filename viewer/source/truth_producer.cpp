#include "viewer/source/truth_producer.h"

#include <algorithm>
#include <utility>

#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

SourceInfo truth_info(SourceInfo info) {
  info.name += ", truth";
  info.kind = "truth";
  info.calibration = {};
  info.has_readings = false;
  info.has_uncertainty = false;
  info.solver = "true forces";
  info.warnings.clear();
  return info;
}

/// Every loaded pillar is determined.
void set_status(ForceField& truth) {
  for (std::size_t i = 0; i < truth.pillars(); ++i) {
    const bool loaded = truth.normal[i] != 0 || truth.shear_x[i] != 0 || truth.shear_y[i] != 0;
    truth.status[i] = loaded ? status::kUsable : 0;
  }
}

}  // namespace

TruthProducer::TruthProducer(const SourceInfo& solved, Reader read)
    : info_(truth_info(solved)),
      read_(std::move(read)),
      truth_(info_.skin.pillar_rows(), info_.skin.pillar_cols()),
      blocks_(kMostShown, [this] {
        return std::make_unique<PlaneBlock>(info_.skin.pillar_rows(), info_.skin.pillar_cols(),
                                            false);
      }) {}

ShownField TruthProducer::produce(std::uint64_t index) {
  const std::shared_ptr<PlaneBlock> block = blocks_.acquire();
  if (block == nullptr) throw_all_fields_in_use();
  const double time_s = read_(index, truth_);
  set_status(truth_);
  block->copy(truth_.view());
  ShownField field;
  field.forces = block->view();
  field.time_s = time_s;
  field.index = index;
  field.pages = block->pages();
  field.keep_alive = block;
  return field;
}

}  // namespace pillarfield::viewer
