#include "solve/sensel_reader.h"

#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "skin/raw_reading.h"
#include "solve/curvature_follower.h"
#include "solve/stages.h"

namespace pillarfield {

namespace maths = single_precision;

SenselReader::SenselReader(const SolverPlan& plan, const FrameView& frame, SensorState* state)
    : calibration_(plan.calibration),
      frame_(frame),
      quad_rows_(quad_rows(plan.skin)),
      quad_cols_(quad_cols(plan.skin)),
      stages_(plan_constants<maths::Stages>(plan)),
      state_(state),
      noise_(static_cast<float>(reading_noise(plan))) {
  const SensorEffects& effects = plan.calibration.effects;
  stages_.curve_polynomial = curve_polynomial(effects.curve).polynomial;
  if (!calibration_.bend_x.empty()) bend(plan);
  wires_ = WireFactors(plan, frame, tares());
  if (!effects.memory) return;
  stages_.memory_model = memory_model(*effects.memory, plan.frame_interval_s);
  if (state_ == nullptr) return;
  const std::size_t states = effects.memory->plays.size() + effects.memory->creep.size();
  state_->states.resize((1 + 2 * states) * quads(plan.skin));
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
  maths::Pillar pillar = {freed(top, left + 1), freed(top, left), freed(top + 1, left),
                          freed(top + 1, left + 1)};
  if (stages_.memory) pillar = recalled(pillar, row * quad_cols_ + col);
  return {active(pillar.s1, top, left + 1), active(pillar.s2, top, left),
          active(pillar.s3, top + 1, left), active(pillar.s4, top + 1, left + 1)};
}

maths::Noise SenselReader::noise(std::size_t row, std::size_t col) const {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  return {sensel_noise(top, left + 1), sensel_noise(top, left), sensel_noise(top + 1, left),
          sensel_noise(top + 1, left + 1)};
}

maths::Sensel SenselReader::untared(std::size_t row, std::size_t col) const {
  return maths::untared_sensel(reading(row, col), correction(row, col), stages_);
}

maths::Sensel SenselReader::linear(std::size_t row, std::size_t col) const {
  return maths::linear_sensel(reading(row, col), correction(row, col), stages_);
}

maths::Sensel SenselReader::freed(std::size_t row, std::size_t col) const {
  const maths::Sensel sensel = linear(row, col);
  return stages_.leak ? without_leak(sensel, row, col) : sensel;
}

maths::Sensel SenselReader::active(maths::Sensel sensel, std::size_t row, std::size_t col) const {
  return maths::active_sensel(sensel, correction(row, col), stages_);
}

/// Zero outside the pillars; rows and columns before the first are huge numbers.
float SenselReader::leak_source(std::size_t row, std::size_t col) const {
  if (row / 2 >= quad_rows_ || col / 2 >= quad_cols_) return 0;
  const std::size_t beside = col + static_cast<std::size_t>(maths::inward(static_cast<int>(col)));
  const maths::Sensel sensel = linear(row, col);
  return maths::source_or(sensel, maths::leak_source(sensel, stages_.threshold),
                          maths::leak_source(linear(row, beside), stages_.threshold));
}

maths::Sensel SenselReader::without_leak(maths::Sensel sensel, std::size_t row,
                                         std::size_t col) const {
  const int in_v = maths::inward(static_cast<int>(row));
  const int in_h = maths::inward(static_cast<int>(col));
  const auto at = [&](int down, int right) {
    return leak_source(row + static_cast<std::size_t>(down), col + static_cast<std::size_t>(right));
  };
  const maths::Neighbours neighbours = PF_NEIGHBOURS(at, in_v, in_h);
  return maths::remove_leak(sensel, neighbours, maths::leak_taps(stages_), stages_.threshold);
}

maths::Pillar SenselReader::recalled(const maths::Pillar& pillar, std::size_t index) {
  const maths::MemoryModel& model = stages_.memory_model;
  if (state_ == nullptr) {
    return maths::recall(pillar, maths::Memory{}, model, stages_.threshold, 1).pillar;
  }
  if (!maths::is_touched_pillar(pillar, stages_.threshold)) return pillar;
  const std::size_t words = 1 + 2 * static_cast<std::size_t>(model.plays + model.creeps);
  std::uint32_t* const stored = state_->states.data() + index * words;
  maths::Memory memory{};
  const auto for_each_pair = [&](const auto& act) {
    for (int i = 0; i < PF_MAX_STATES; ++i) {
      const int number = maths::number_of_state(i, model);
      for (int row = 0; number >= 0 && row < 2; ++row) act(row, i, stored[1 + 2 * number + row]);
    }
  };
  memory.last = stored[0];
  for_each_pair([&](int row, int i, std::uint32_t word) { memory.pair[row][i] = word; });
  const maths::Recalled result =
      maths::recall(pillar, memory, model, stages_.threshold, state_->frame);
  stored[0] = result.memory.last;
  for_each_pair([&](int row, int i, std::uint32_t& word) { word = result.memory.pair[row][i]; });
  return result.pillar;
}

float SenselReader::sensel_noise(std::size_t row, std::size_t col) const {
  const float noise =
      calibration_.noise.empty() ? noise_ : value_of(calibration_.noise, row, col, 0.0F);
  return maths::corrected_noise(noise, reading(row, col), correction(row, col), stages_);
}

const std::vector<float>& SenselReader::tares() const {
  return state_ != nullptr && state_->curvature ? state_->tare : calibration_.tare;
}

maths::Correction SenselReader::correction(std::size_t row, std::size_t col) const {
  return {value_of(tares(), row, col, 0.0F), value_of(calibration_.gain, row, col, 0.0F),
          value_of(calibration_.dead_zone, row, col, 0.0F),
          value_of(calibration_.mask, row, col, kAbsent), wires_.at(row, col)};
}

float SenselReader::reading(std::size_t row, std::size_t col) const {
  return exists(row, col) ? raw_reading(frame_, row, col) : 0;
}

bool SenselReader::exists(std::size_t row, std::size_t col) const {
  return row < frame_.rows && col < frame_.cols;
}

template <class Value>
float SenselReader::value_of(const std::vector<Value>& plane, std::size_t row, std::size_t col,
                             Value otherwise) const {
  if (plane.empty()) return 0;
  return static_cast<float>(exists(row, col) ? plane[row * frame_.cols + col] : otherwise);
}

}  // namespace pillarfield
