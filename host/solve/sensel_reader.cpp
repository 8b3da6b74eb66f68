#include "solve/sensel_reader.h"

#include "pillarfield/tuning.h"
#include "skin/raw_reading.h"
#include "solve/curvature_follower.h"
#include "solve/plan_constants.h"

namespace pillarfield {

namespace maths = single_precision;

namespace {

/// The part of the neighbours of a sensel that lie in one direction: the offset to the one under
/// the same pillar, and the opposite one.
int inward(std::size_t at) { return at % 2 == 0 ? 1 : -1; }

}  // namespace

SenselReader::SenselReader(const SolverPlan& plan, const FrameView& frame, SensorState* state)
    : calibration_(plan.calibration),
      frame_(frame),
      stages_(plan_constants<maths::Stages>(plan)),
      wires_(plan, frame),
      state_(state),
      noise_(static_cast<float>(reading_noise(plan))) {
  const SensorEffects& effects = plan.calibration.effects;
  stages_.curve_polynomial = curve_polynomial(effects.curve).polynomial;
  if (effects.sensel_leak) {
    const auto taps = leak_taps(*effects.sensel_leak);
    const auto real = [](double tap) { return static_cast<float>(tap); };
    stages_.leak_taps = {real(taps.self),        real(taps.inside), real(taps.across),
                         real(taps.both_inside), real(taps.mixed),  real(taps.both_across)};
  }
  if (!calibration_.bend_x.empty()) bend(plan);
  if (!effects.memory) return;
  stages_.memory_model = memory_model(*effects.memory, plan.frame_interval_s);
  if (state_ == nullptr) return;
  const std::size_t states = effects.memory->plays.size() + effects.memory->creep.size();
  state_->values.resize(states * plan.skin.sensels());
  state_->last_active.resize(plan.skin.sensels());
  ++state_->frame;
}

void SenselReader::bend(const SolverPlan& plan) {
  if (state_ == nullptr) return;
  if (!state_->curvature) {
    state_->curvature = std::make_shared<CurvatureFollower>(plan);
    state_->tare = calibration_.tare;
    state_->tare.resize(plan.skin.sensels());
  }
  const std::optional<Curvature> change = state_->curvature->follow(frame_);
  if (!change) return;
  const maths::Curvature bent = {static_cast<float>(change->x), static_cast<float>(change->y),
                                 static_cast<float>(change->xy)};
  for (std::size_t i = 0; i < state_->tare.size(); ++i) {
    state_->tare[i] = maths::bent_tare(state_->tare[i], calibration_.bend_x[i],
                                       calibration_.bend_y[i], calibration_.bend_xy[i], bent);
  }
}

maths::Pillar SenselReader::pillar(std::size_t row, std::size_t col) {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  return {sensel(top, left + 1), sensel(top, left), sensel(top + 1, left),
          sensel(top + 1, left + 1)};
}

maths::Noise SenselReader::noise(std::size_t row, std::size_t col) const {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  return {sensel_noise(top, left + 1), sensel_noise(top, left), sensel_noise(top + 1, left),
          sensel_noise(top + 1, left + 1)};
}

maths::Sensel SenselReader::untared(std::size_t row, std::size_t col) const {
  return maths::untared_sensel(raw_reading(frame_, row, col), correction(row, col), stages_);
}

maths::Sensel SenselReader::linear(std::size_t row, std::size_t col) const {
  return maths::linear_sensel(raw_reading(frame_, row, col), correction(row, col), stages_);
}

maths::Sensel SenselReader::sensel(std::size_t row, std::size_t col) {
  maths::Sensel sensel = linear(row, col);
  if (stages_.leak) sensel = without_leak(sensel, row, col);
  if (stages_.memory) sensel = recalled(sensel, row, col);
  return maths::active_sensel(sensel, correction(row, col), stages_);
}

/// Zero outside the pillars; rows and columns before the first are huge numbers.
float SenselReader::leak_source(std::size_t row, std::size_t col) const {
  if (row / 2 >= frame_.rows / 2 || col / 2 >= frame_.cols / 2) return 0;
  const std::size_t beside = col + static_cast<std::size_t>(inward(col));
  const maths::Sensel sensel = linear(row, col);
  return maths::source_or(sensel, maths::leak_source(sensel, stages_.threshold),
                          maths::leak_source(linear(row, beside), stages_.threshold));
}

maths::Sensel SenselReader::without_leak(maths::Sensel sensel, std::size_t row,
                                         std::size_t col) const {
  const auto in_h = static_cast<std::size_t>(inward(col));
  const auto in_v = static_cast<std::size_t>(inward(row));
  const auto at = [&](std::size_t down, std::size_t right) {
    return leak_source(row + down, col + right);
  };
  const maths::Neighbours neighbours = {at(0, in_h),     at(in_v, 0),     at(0, -in_h),
                                        at(-in_v, 0),    at(in_v, in_h),  at(-in_v, in_h),
                                        at(in_v, -in_h), at(-in_v, -in_h)};
  return maths::remove_leak(sensel, neighbours, stages_.leak_taps, stages_.threshold);
}

maths::Sensel SenselReader::recalled(maths::Sensel sensel, std::size_t row, std::size_t col) {
  const maths::MemoryModel& model = stages_.memory_model;
  if (state_ == nullptr) {
    return maths::recall(sensel, maths::Memory{}, model, stages_.threshold, 0).sensel;
  }
  const std::size_t place = row * frame_.cols + col;
  const auto value = [&](int state) -> float& {
    return state_->values[static_cast<std::size_t>(state) * state_->last_active.size() + place];
  };
  maths::Memory before{};
  for (int i = 0; i < model.plays; ++i) before.play[i] = value(i);
  for (int i = 0; i < model.creeps; ++i) before.creep[i] = value(model.plays + i);
  const auto idle = static_cast<float>(state_->frame - state_->last_active[place] - 1);
  const maths::Recalled result = maths::recall(sensel, before, model, stages_.threshold, idle);
  if (!result.active) return result.sensel;
  for (int i = 0; i < model.plays; ++i) value(i) = result.memory.play[i];
  for (int i = 0; i < model.creeps; ++i) value(model.plays + i) = result.memory.creep[i];
  state_->last_active[place] = state_->frame;
  return result.sensel;
}

float SenselReader::sensel_noise(std::size_t row, std::size_t col) const {
  const float noise =
      calibration_.noise.empty() ? noise_ : calibration_.noise[row * frame_.cols + col];
  return maths::corrected_noise(noise, raw_reading(frame_, row, col), correction(row, col),
                                stages_);
}

maths::Correction SenselReader::correction(std::size_t row, std::size_t col) const {
  const std::size_t index = row * frame_.cols + col;
  const auto value = [index](const auto& plane) {
    return plane.empty() ? 0.0F : static_cast<float>(plane[index]);
  };
  const bool bent = state_ != nullptr && state_->curvature;
  return {value(bent ? state_->tare : calibration_.tare), value(calibration_.gain),
          value(calibration_.dead_zone), value(calibration_.mask), wires_.at(row, col)};
}

}  // namespace pillarfield
