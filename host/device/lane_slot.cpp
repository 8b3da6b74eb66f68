#include "device/lane_slot.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "skin/quads.h"
#include "solve/activation_thresholds.h"
#include "solve/sensor_corrections.h"
#include "solve/stages.h"
#include "solve/whole_numbers.h"

namespace pillarfield {
namespace {

/// Blocks of 2 x 2 sensels from which on threads share a frame: waking them takes 10 µs.
constexpr std::size_t kQuadsOfThreads = 8192;

std::size_t bands_of(const SolverPlan& plan) {
  constexpr std::size_t kBandsPerThread = 4;
  if (quads(plan.skin) < kQuadsOfThreads) return 1;
  const std::size_t threads = std::max(std::thread::hardware_concurrency(), 1U);
  return std::min<std::size_t>(quad_rows(plan.skin), kBandsPerThread * threads);
}

single_precision::Stages lane_stages(const SolverPlan& plan, bool whole) {
  auto stages = named_stages<single_precision::Stages>(plan);
  const std::vector<StageConstant> constants = stage_constants(plan);
  std::size_t i = 0;
  const auto next = [&] {
    const StageConstant& constant = constants[i++];
    if (!constant.is_needed) return 0.0F;
    return single_constant(whole ? whole_value(constant, plan) : constant.value);
  };
#define PF_SET(name, needed, kind, formula) stages.name = next();
  PF_STAGE_CONSTANTS(PF_SET)
#undef PF_SET
  stages.largest = static_cast<float>(kMaxCounts);  // find_wires.cl reads it of all types
  const SensorEffects& effects = plan.calibration.effects;
  if (!effects.curve.empty()) stages.curve_polynomial = curve_polynomial(effects.curve).polynomial;
  if (effects.memory) stages.memory_model = memory_model(*effects.memory, plan.frame_interval_s);
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
  find(CalibrationPlane::memory, places.memory);
  return places;
}

LaneActivation activation_of(const SolverPlan& plan, bool whole) {
  const ActivationRange range = activation_range(plan);
  LaneActivation activation;
  activation.cut = single_constant(range.threshold);
  activation.step = single_constant(range.step);
  activation.lowest = single_constant(range.lowest);
  activation.highest = single_constant(range.highest);
  activation.never = single_constant(range.never);
  if (has_offset_tares(plan.calibration.effects)) {
    activation.idle_load = single_constant(idle_load(plan));
  }
  if (whole) activation.of_all = activation_thresholds(plan).front();
  return activation;
}

LaneWires wires_of(const SolverPlan& plan) {
  if (!plan.calibration.effects.wires) return {};
  const WireCrosstalk& wires = *plan.calibration.effects.wires;
  return {static_cast<std::uint32_t>(wires.tile_rows), static_cast<std::uint32_t>(wires.tile_cols),
          single_constant(wires.row_per_count), single_constant(wires.column_per_count),
          single_constant(wires.idle_per_count)};
}

template <class Reading>
void convert(const FrameView& frame, std::size_t stride, float* to) {
  const auto* row = static_cast<const Reading*>(frame.data);
  for (std::size_t i = 0; i < frame.rows; ++i, row += frame.row_stride, to += stride) {
    std::transform(row, row + frame.cols, to,
                   [](Reading reading) { return static_cast<float>(reading); });
  }
}

}  // namespace

LaneSettings::LaneSettings(const SolverPlan& plan, const LaneProgram& chosen)
    : program(&chosen),
      whole(is_whole(plan) &&
            quad_cols(plan.skin) >= static_cast<std::uint32_t>(chosen.whole_lanes)),
      division{whole ? chosen.whole_lanes : chosen.lanes, bands_of(plan)} {}

std::vector<CalibrationPlane> lane_planes(const SolverPlan& plan, const LaneSettings& settings) {
  return calibration_planes(plan, !settings.whole);
}

LaneSlot::LaneSlot(const SolverPlan& plan, const LaneSettings& settings,
                   const CalibrationMemory& calibration, FrameOrder& order, ThreadPool* pool)
    : LaneSlot(plan, settings, calibration, order, pool,
               SlotLayout(plan, settings.division, true, calibration)) {}

LaneSlot::LaneSlot(const SolverPlan& plan, const LaneSettings& settings,
                   const CalibrationMemory& calibration, FrameOrder& order, ThreadPool* pool,
                   const SlotLayout& slot)
    : Slot(plan.skin, order),
      plan_{lane_stages(plan, settings.whole), settings.whole, places_of(calibration.planes()),
            activation_of(plan, settings.whole), wires_of(plan)},
      program_(settings.program),
      bands_{1, settings.division.bands},
      tiles_{slot.tiles_across, slot.tiles_down},
      corrects_(corrects_forces(plan)),
      pool_(pool),
      memory_(slot.results),
      padded_cols_(padded_cols(plan.skin)) {
  frame_.calibration = reinterpret_cast<unsigned char*>(calibration.bytes());
  frame_.results = reinterpret_cast<unsigned char*>(memory_.bytes());
  frame_.layout = slot.layout;
  const bool in_place =
      plan.sensel_type == SenselType::f32 && padded_sensels(plan.skin) == plan.skin.sensels();
  if (!settings.whole && !in_place) readings_.resize(padded_sensels(plan.skin));
}

void LaneSlot::read(const FrameView& frame) {
  if (readings_.empty()) {
    frame_.raw = frame.data;
    frame_.layout.row_stride = frame.row_stride;
    return;
  }
  if (frame.type == SenselType::u8) {
    convert<std::uint8_t>(frame, padded_cols_, readings_.data());
  } else if (frame.type == SenselType::u16) {
    convert<std::uint16_t>(frame, padded_cols_, readings_.data());
  } else {
    convert<float>(frame, padded_cols_, readings_.data());
  }
  frame_.raw = readings_.data();
  frame_.layout.row_stride = padded_cols_;
}

void LaneSlot::run(LaneProgram::Run work, LaneRange range) {
  if (pool_ == nullptr || range.down == 1) return work(plan_, frame_, range, 0, range.down);
  pool_->run(range.down,
             [&](std::size_t piece, std::size_t) { work(plan_, frame_, range, piece, piece + 1); });
}

void LaneSlot::submit(const FrameView& frame, const std::optional<Curvature>& bent,
                      const single_precision::Drift& drift) {
  read(frame);
  frame_.layout.frame = ++order().frame;
  if (bent) {
    program_->bend_tare(
        plan_, frame_,
        {static_cast<float>(bent->x), static_cast<float>(bent->y), static_cast<float>(bent->xy)});
  }
  if (plan_.stages.wires) run(program_->find_wires, tiles_);
  run(program_->solve_frame, bands_);
  if (order().follows_baseline) {
    program_->follow_baseline(plan_, frame_, order().rate, drift, order().first_row(),
                              order().interval);
  }
  if (plan_.stages.pillar_leak) run(program_->remove_pillar_leak, bands_);
  if (plan_.stages.lean) run(program_->find_shear_ratios, bands_);
  if (corrects_) run(program_->correct_forces, bands_);
}

}  // namespace pillarfield
