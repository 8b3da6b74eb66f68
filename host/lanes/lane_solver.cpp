#include "lanes/lane_solver.h"

#include <algorithm>
#include <thread>

#include "skin/quads.h"
#include "solve/activation_thresholds.h"
#include "solve/curvature_follower.h"
#include "solve/sensor_corrections.h"
#include "solve/stages.h"
#include "solve/whole_numbers.h"

namespace pillarfield {
namespace {

/// Bands of rows that threads share. Waking them takes some 10 µs, in which one thread solves
/// 10,000 pillars without effects of a sensor, or some hundreds with all of them.
std::size_t bands_of(const SolverPlan& plan) {
  constexpr std::size_t kBandsPerThread = 4;
  const std::size_t least = plan.calibration.effects.empty() && !plan.uncertainty ? 65536 : 4096;
  if (quads(plan.skin) < least) return 1;
  const std::size_t threads = std::max(std::thread::hardware_concurrency(), 1U);
  return std::min<std::size_t>(quad_rows(plan.skin), kBandsPerThread * threads);
}

single_precision::Stages lane_stages(const SolverPlan& plan, bool whole) {
  auto stages = named_stages<single_precision::Stages>(plan);
  static_cast<single_precision::PlanNumbers&>(stages) = plan_numbers(plan, whole);
  return stages;
}

LanePlanes places_of(const std::vector<CalibrationPlane>& planes) {
  LanePlanes places;
  const auto find = [&](CalibrationPlane plane, std::size_t& place) {
    const auto found = std::ranges::find(planes, plane);
    if (found == planes.end()) return false;
    place = static_cast<std::size_t>(found - planes.begin());
    return true;
  };
  find(CalibrationPlane::tare, places.tare);
  find(CalibrationPlane::gain, places.gain);
  find(CalibrationPlane::dead_zone, places.dead_zone);
  places.has_noise = find(CalibrationPlane::noise, places.noise);
  find(CalibrationPlane::mask, places.mask);
  find(CalibrationPlane::activation, places.activation);
  find(CalibrationPlane::bend_x, places.bend_x);
  find(CalibrationPlane::bend_y, places.bend_y);
  find(CalibrationPlane::bend_xy, places.bend_xy);
  find(CalibrationPlane::release, places.release);
  find(CalibrationPlane::memory, places.memory);
  return places;
}

template <class Reading>
void convert(const FrameView& frame, std::size_t row, float* to) {
  const auto* const from = static_cast<const Reading*>(frame.data) + row * frame.row_stride;
  std::transform(from, from + frame.cols, to,
                 [](Reading reading) { return static_cast<float>(reading); });
}

/// Writes a row of readings as float.
void convert_row(const FrameView& frame, std::size_t row, float* to) {
  if (frame.type == SenselType::u8) return convert<std::uint8_t>(frame, row, to);
  if (frame.type == SenselType::u16) return convert<std::uint16_t>(frame, row, to);
  convert<float>(frame, row, to);
}

/// No program has a single lane.
bool is_narrow(const SolverPlan& plan) { return quad_cols(plan.skin) == 1; }

/// A plan with a single column of blocks of 2 x 2 sensels as one of two, the second absent.
SolverPlan widened(SolverPlan plan) {
  const std::size_t cols = plan.skin.cols;  // 2, or 3 with one under no pillar
  plan.skin.cols = 4;
  const auto widen = [&](auto& plane, auto absent, std::size_t kept = 2) {
    if (plane.empty()) return;
    auto wide = std::vector(plan.skin.sensels(), absent);
    for (std::size_t i = 0; i < plane.size(); ++i) {
      if (i % cols < kept) wide[i / cols * 4 + i % cols] = plane[i];
    }
    plane = std::move(wide);
  };
  Calibration& planes = plan.calibration;
  if (planes.mask.empty()) planes.mask.assign(plan.skin.rows * cols, kGood);
  widen(planes.mask, kAbsent);
  widen(planes.gain, 1.0F);
  widen(planes.tare, 0.0F, cols);
  for (auto* const plane :
       {&planes.dead_zone, &planes.noise, &planes.bend_x, &planes.bend_y, &planes.bend_xy}) {
    widen(*plane, 0.0F);
  }
  return plan;
}

SlotLayout slot_layout(const SolverPlan& plan, const LaneSettings& settings,
                       const CalibrationMemory& calibration) {
  if (is_narrow(plan)) return slot_layout(widened(plan), settings, calibration);
  return {plan, settings.division, true, calibration};
}

/// Copies the first columns of results.
void copy_columns(const ResultMemory& from, const ResultMemory& to) {
  const std::size_t cols = to.layout().cols;
  const auto copy_plane = [&](const auto* plane, auto* first) {
    for (std::size_t row = 0; row < to.layout().rows; ++row) {
      std::copy_n(plane + row * from.layout().cols, cols, first + row * cols);
    }
  };
  copy_plane(from.status(), to.status());
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    if (to.plane(i) == nullptr) continue;
    copy_plane(reinterpret_cast<const float*>(from.plane(i)),
               reinterpret_cast<float*>(to.plane(i)));
  }
}

}  // namespace

LaneSettings::LaneSettings(const SolverPlan& plan, int most)
    : program(&lane_program(quad_cols(plan.skin), most)),
      whole(is_whole(plan) &&
            quad_cols(plan.skin) >= static_cast<std::uint32_t>(program->whole_lanes)),
      division{whole ? program->whole_lanes : program->lanes, bands_of(plan)} {}

CalibrationMemory lane_calibration(const SolverPlan& plan, const LaneSettings& settings) {
  if (is_narrow(plan)) return lane_calibration(widened(plan), settings);
  return {plan, calibration_planes(plan, !settings.whole), SenselType::f32};
}

LaneSolver::LaneSolver(const SolverPlan& plan, const LaneSettings& settings,
                       const CalibrationMemory& calibration, ThreadPool* pool)
    : LaneSolver(plan, settings, calibration, pool, slot_layout(plan, settings, calibration)) {}

LaneSolver::LaneSolver(const SolverPlan& plan, const LaneSettings& settings,
                       const CalibrationMemory& calibration, ThreadPool* pool,
                       const SlotLayout& slot)
    : program_(settings.program),
      bands_{1, settings.division.bands},
      tiles_{slot.tiles_across, slot.tiles_down},
      pool_(pool),
      memory_(slot.results),
      padded_cols_(calibration.stride()) {
  set_plan(plan, settings, calibration);
  if (is_narrow(plan)) narrow_.emplace(ResultLayout(plan, 0));
  frame_.results = reinterpret_cast<unsigned char*>(memory_.bytes());
  frame_.layout = slot.layout;
  const std::size_t padded = padded_rows(plan.skin) * padded_cols_;
  const bool in_place = plan.sensel_type == SenselType::f32 && padded == plan.skin.sensels();
  if (!settings.whole && !in_place) readings_.resize(padded);
}

void LaneSolver::set_plan(const SolverPlan& plan, const LaneSettings& settings,
                          const CalibrationMemory& calibration) {
  if (is_narrow(plan)) return set_plan(widened(plan), settings, calibration);
  plan_ = {lane_stages(plan, settings.whole), settings.whole, places_of(calibration.planes())};
  if (const auto& wires = plan.calibration.effects.wires) {
    plan_.tile_rows = static_cast<std::uint32_t>(wires->tile_rows);
    plan_.tile_cols = static_cast<std::uint32_t>(wires->tile_cols);
  }
  corrects_ = corrects_forces(plan);
  frame_.calibration = reinterpret_cast<unsigned char*>(calibration.bytes());
  memory_.clear_flags();
}

template <class Work>
void LaneSolver::share(std::size_t pieces, const Work& work) {
  if (pool_ == nullptr || pieces == 1) {
    for (std::size_t piece = 0; piece < pieces; ++piece) work(piece);
    return;
  }
  pool_->run(pieces, [&](std::size_t piece, std::size_t) { work(piece); });
}

void LaneSolver::read(const FrameView& frame) {
  if (readings_.empty()) {
    frame_.raw = frame.data;
    frame_.layout.row_stride = frame.row_stride;
    return;
  }
  const std::size_t pieces = bands_.down;
  share(pieces, [&](std::size_t piece) {
    const std::size_t end = (piece + 1) * frame.rows / pieces;
    for (std::size_t row = piece * frame.rows / pieces; row < end; ++row) {
      convert_row(frame, row, readings_.data() + row * padded_cols_);
    }
  });
  frame_.raw = readings_.data();
  frame_.layout.row_stride = padded_cols_;
}

void LaneSolver::run(LaneProgram::Run work, LaneRange range) {
  share(range.down, [&](std::size_t piece) { work(plan_, frame_, range, piece, piece + 1); });
}

void LaneSolver::solve(const FrameView& frame, const FrameStep& step) {
  read(frame);
  if (narrow_) memory_.clear_flags();  // Its few pillars are solved again.
  frame_.layout.frame = step.number;
  if (step.bent) {
    program_->bend_tare(plan_, frame_,
                        {static_cast<float>(step.bent->x), static_cast<float>(step.bent->y),
                         static_cast<float>(step.bent->xy)});
  }
  if (plan_.stages.wires) run(program_->find_wires, tiles_);
  run(program_->solve_frame, bands_);
  if (step.baseline) {
    const BaselineTurn& turn = *step.baseline;
    program_->follow_baseline(plan_, frame_, turn.pace, turn.drift, turn.first_row, turn.interval);
  }
  if (plan_.stages.pillar_leak) run(program_->remove_pillar_leak, bands_);
  if (plan_.stages.lean) run(program_->find_shear_ratios, bands_);
  if (corrects_) run(program_->correct_forces, bands_);
  if (narrow_) copy_columns(memory_, *narrow_);
}

ForceField solve_in_lanes(const SolverPlan& plan, const FrameView& frame) {
  const LaneSettings settings(plan, lane_programs().front()->lanes);
  const CalibrationMemory calibration = lane_calibration(plan, settings);
  LaneSolver solver(plan, settings, calibration);
  FrameStep step;
  if (!plan.calibration.bend_x.empty()) step.bent = CurvatureFollower(plan).follow(frame);
  solver.solve(frame, step);
  return ForceField(solver.memory().forces());
}

}  // namespace pillarfield
