#include "core/field_estimate.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

constexpr std::size_t kFloatPlanes = 6;

/// Threads share pillars that stay alone in such lots; a smaller one is not worth waking them.
constexpr std::size_t kAlonePiece = 1024;

/// A plane's values; null where it is empty.
float* values(std::vector<float>& plane) { return plane.empty() ? nullptr : plane.data(); }

maths::Field planes_of(ForceField& field) {
  auto& uncertainty = field.uncertainty;
  return {field.shear_x.data(),
          field.shear_y.data(),
          field.normal.data(),
          field.status.data(),
          nullptr,
          nullptr,
          nullptr,
          values(uncertainty[Uncertainty::shear_x]),
          values(uncertainty[Uncertainty::shear_y]),
          values(uncertainty[Uncertainty::normal]),
          values(uncertainty[Uncertainty::theta_low]),
          values(uncertainty[Uncertainty::theta_high]),
          values(uncertainty[Uncertainty::phi_low]),
          values(uncertainty[Uncertainty::phi_high]),
          values(uncertainty[Uncertainty::magnitude_low]),
          values(uncertainty[Uncertainty::magnitude_high]),
          field.rows,
          field.cols};
}

}  // namespace

HostFieldEstimator::HostFieldEstimator(const SolverPlan& plan, std::size_t threads)
    : work_(plan), team_(std::make_unique<WorkTeam>(threads)) {
  if (!plan.field.frames_close) return;
  past_normal_.resize(plan.skin.pillars());
  past_deviation_.resize(plan.skin.pillars());
  past_frame_.resize(plan.skin.pillars());
}

single_precision::Past HostFieldEstimator::past() {
  if (past_normal_.empty()) return {nullptr, nullptr, nullptr, now_};
  return {past_normal_.data(), past_deviation_.data(), past_frame_.data(), now_};
}

single_precision::Scratch HostFieldEstimator::scratch(std::size_t tile) {
  const std::size_t cells = work_.cells();
  float* const planes = planes_.data();
  const maths::Cells all = {kinds_.data(),      planes,
                            planes + cells,     planes + 2 * cells,
                            planes + 3 * cells, planes + 4 * cells,
                            planes + 5 * cells};
  return {all, lines_.data(), shared_.data() + tile * PF_SHARED_SUMS,
          counts_.data() + tile * PF_RATIO_COUNTS};
}

void HostFieldEstimator::resolve_alone(const maths::Field& field,
                                       std::span<const std::uint32_t> pillars) {
  for (const std::uint32_t index : pillars) {
    maths::resolve_alone(field, past(), index, work_.settings());
  }
}

void HostFieldEstimator::make_room() {
  const std::size_t tiles = work_.tiles().size();
  kinds_.resize(work_.cells());
  planes_.resize(kFloatPlanes * work_.cells());
  lines_.resize(PF_LINE_SUMS * work_.lines());
  shared_.resize(PF_SHARED_SUMS * tiles);
  counts_.resize(PF_RATIO_COUNTS * tiles);
  verdicts_.resize(tiles);
}

void HostFieldEstimator::resolve(ForceField& field) { resolve(planes_of(field)); }

void HostFieldEstimator::resolve(const maths::Field& field, const SilentBlocks& silent) {
  work_.find({field.status, std::size_t{field.rows} * field.cols}, silent);
  ++now_;
  make_room();
  runs_.clear();
  for (const ContactRun& run : work_.map().runs()) {
    runs_.push_back({run.row, run.first, run.end, run.contact});
  }
  const std::size_t tiles = work_.tiles().size();
  const std::size_t shared_alone = work_.alone().size() / kAlonePiece;
  team_->run(tiles + shared_alone, [&](std::size_t piece, std::size_t) {
    if (piece < tiles) {
      verdicts_[piece] = maths::resolve_contact(work_.tiles()[piece], scratch(piece), field, past(),
                                                runs_.data(), work_.settings(), {0, 1});
    } else {
      const std::size_t first = (piece - tiles) * kAlonePiece;
      resolve_alone(field, std::span(work_.alone()).subspan(first, kAlonePiece));
    }
  });
  resolve_alone(field, std::span(work_.alone()).subspan(shared_alone * kAlonePiece));
  if (past_normal_.empty()) return;
  for (const maths::Run& run : runs_) maths::keep_run(field, past(), run, work_.settings().noise);
}

}  // namespace pillarfield
