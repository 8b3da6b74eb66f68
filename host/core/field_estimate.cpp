#include "core/field_estimate.h"

#include <algorithm>

#include "core/field_planes.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

constexpr std::size_t kFloatPlanes = 6;

/// Threads share pillars that stay alone in such lots; a smaller one is not worth waking them.
constexpr std::size_t kAlonePiece = 1024;

}  // namespace

HostFieldEstimator::HostFieldEstimator(const SolverPlan& plan, std::size_t threads)
    : work_(plan), rooms_(threads), team_(std::make_unique<WorkTeam>(threads)) {
  if (!plan.field.frames_close) return;
  past_normal_.resize(plan.skin.pillars());
  past_deviation_.resize(plan.skin.pillars());
  past_frame_.resize(plan.skin.pillars());
}

single_precision::Past HostFieldEstimator::past() {
  if (past_normal_.empty()) return {nullptr, nullptr, nullptr, now_};
  return {past_normal_.data(), past_deviation_.data(), past_frame_.data(), now_};
}

single_precision::Scratch HostFieldEstimator::Room::scratch(const maths::Tile& tile) {
  const std::size_t cells = (std::size_t{tile.rows} + 2) * (tile.cols + 2);
  const auto hold = [](auto& memory, std::size_t values) {
    if (memory.size() < values) memory.resize(values);
  };
  hold(kinds, cells);
  hold(planes, kFloatPlanes * cells);
  hold(lines, PF_LINE_SUMS * std::size_t{tile.rows});
  hold(shared, PF_SHARED_SUMS);
  hold(counts, PF_RATIO_COUNTS);
  float* const first = planes.data();
  const maths::Cells all = {kinds.data(),      first,
                            first + cells,     first + 2 * cells,
                            first + 3 * cells, first + 4 * cells,
                            first + 5 * cells};
  return {all, lines.data(), shared.data(), counts.data()};
}

/// Asks for the forces of runs: what the device wrote is in the caches of other cores.
void HostFieldEstimator::ask_for(const maths::Field& field, std::span<const maths::Run> runs) {
#if defined(__GNUC__)
  constexpr std::uint32_t kLine = 64 / sizeof(float);
  for (const maths::Run& run : runs) {
    const std::size_t row = std::size_t{run.row} * field.cols;
    for (std::uint32_t col = run.first; col < run.end + kLine - 1; col += kLine) {
      const std::size_t at = row + std::min(col, run.end - 1);
      __builtin_prefetch(field.shear_x + at);
      __builtin_prefetch(field.shear_y + at);
      __builtin_prefetch(field.normal + at);
    }
  }
#endif
}

maths::Verdict HostFieldEstimator::resolve_tile(const maths::Field& field, maths::Tile tile,
                                                Room& room) {
  ask_for(field, std::span(runs_).subspan(tile.first_run, tile.runs));
  tile.first_cell = 0;
  tile.first_line = 0;
  return maths::resolve_contact(tile, room.scratch(tile), field, past(), runs_.data(),
                                work_.settings(), {0, 1});
}

void HostFieldEstimator::resolve_alone(const maths::Field& field,
                                       std::span<const std::uint32_t> pillars) {
  for (std::size_t i = 0; i < pillars.size(); ++i) {
#if defined(__GNUC__)
    constexpr std::size_t kAhead = 8;
    if (i + kAhead < pillars.size()) {
      const std::uint32_t ahead = pillars[i + kAhead];
      __builtin_prefetch(field.shear_x + ahead);
      __builtin_prefetch(field.shear_y + ahead);
      __builtin_prefetch(field.normal + ahead);
    }
#endif
    maths::resolve_alone(field, past(), pillars[i], work_.settings());
  }
}

void HostFieldEstimator::resolve(ForceField& field) { resolve(planes_of(field)); }

void HostFieldEstimator::resolve(const maths::Field& field, const SilentBlocks& silent) {
  work_.find({field.status, std::size_t{field.rows} * field.cols}, silent);
  ++now_;
  verdicts_.resize(work_.tiles().size());
  runs_.clear();
  for (const ContactRun& run : work_.map().runs()) {
    runs_.push_back({run.row, run.first, run.end, run.contact});
  }
  const std::size_t tiles = work_.tiles().size();
  // The last lot is shared where threads are awake for others.
  std::size_t shared_alone = work_.alone().size() / kAlonePiece;
  if (tiles + shared_alone > 1)
    shared_alone = (work_.alone().size() + kAlonePiece - 1) / kAlonePiece;
  const std::span<const std::uint32_t> alone = work_.alone();
  team_->run(tiles + shared_alone, [&](std::size_t piece, std::size_t member) {
    if (piece < tiles) {
      verdicts_[piece] = resolve_tile(field, work_.tiles()[piece], rooms_[member]);
    } else {
      const std::size_t first = (piece - tiles) * kAlonePiece;
      resolve_alone(field, alone.subspan(first, std::min(kAlonePiece, alone.size() - first)));
    }
  });
  resolve_alone(field, alone.subspan(std::min(shared_alone * kAlonePiece, alone.size())));
  if (past_normal_.empty()) return;
  for (const maths::Run& run : runs_) maths::keep_run(field, past(), run, work_.settings().noise);
}

}  // namespace pillarfield
