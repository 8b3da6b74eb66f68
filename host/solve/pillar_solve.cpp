#include "solve/pillar_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "solve/drift_follower.h"
#include "solve/pillar_lean.h"
#include "solve/pillar_maths.h"
#include "solve/result_planes.h"
#include "solve/sensel_reader.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

void store_solution(const maths::Solution& solution, std::size_t index, bool uncertainty,
                    ForceField& field) {
#define PF_STORE(name, unit, value) field.name[index] = solution.value;
  PF_FORCE_PLANES(PF_STORE)
#undef PF_STORE
  if (!uncertainty) return;
#define PF_STORE(name, unit, value) field.uncertainty[Uncertainty::name][index] = solution.value;
  PF_UNCERTAINTY_PLANES(PF_STORE)
#undef PF_STORE
}

/// Solves the 2 x 2 sensels of a pillar, or, without pillars, each for itself.
class QuadSolver {
 public:
  QuadSolver(const SolverPlan& plan, const FrameView& frame, SensorState& state, ForceField& field)
      : sensels_(plan, frame, &state), field_(field) {
    if (!plan.uncertainty) return;
    for (std::size_t i = kNamedPlanes; i < kSolvedPlanes; ++i) {
      if (!has_plane(plan.skin.layout, false, true, kResultPlanes[i])) continue;
      field.uncertainty[static_cast<Uncertainty>(i - kNamedPlanes)].resize(field.elements());
    }
  }

  [[nodiscard]] const maths::Stages& stages() const { return sensels_.stages(); }

  void solve(std::size_t row, std::size_t col) {
    const bool uncertainty = sensels_.stages().uncertainty;
    const maths::Noise noise = uncertainty ? sensels_.noise(row, col) : maths::Noise{};
    const maths::Pillar sensels = sensels_.pillar(row, col);
    if (sensels_.stages().sensel_force) return solve_sensels(sensels, noise, 2 * row, 2 * col);
    const maths::Solution solution = maths::solve_pillar(sensels, noise, sensels_.stages());
    const std::size_t index = row * field_.cols + col;
    field_.status[index] = static_cast<std::uint8_t>(solution.status);
    store_solution(solution, index, uncertainty, field_);
  }

 private:
  /// Solves those of the four that exist; the upper left one is at (row, col).
  void solve_sensels(const maths::Pillar& sensels, const maths::Noise& noise, std::size_t row,
                     std::size_t col) {
    const auto solve_one = [&](const maths::Sensel& sensel, float deviation, std::size_t r,
                               std::size_t c) {
      if (r >= field_.rows || c >= field_.cols) return;
      const maths::SenselSolution solution =
          maths::solve_sensel(sensel, deviation, sensels_.stages());
      const std::size_t index = r * field_.cols + c;
      field_.normal[index] = solution.normal;
      field_.status[index] = static_cast<std::uint8_t>(solution.status);
      if (sensels_.stages().uncertainty) {
        field_.uncertainty[Uncertainty::normal][index] = solution.deviation;
      }
    };
    solve_one(sensels.s1, noise.n1, row, col + 1);
    solve_one(sensels.s2, noise.n2, row, col);
    solve_one(sensels.s3, noise.n3, row + 1, col);
    solve_one(sensels.s4, noise.n4, row + 1, col + 1);
  }

  SenselReader sensels_;
  ForceField& field_;
};

/// Values of a plane around a pillar; zero outside.
class PlaneView {
 public:
  PlaneView(std::span<const float> values, const ForceField& field)
      : values_(values), rows_(field.rows), cols_(field.cols) {}

  /// Rows and columns before the first are huge numbers.
  [[nodiscard]] float at(std::size_t row, std::size_t col) const {
    return row < rows_ && col < cols_ ? values_[row * cols_ + col] : 0;
  }

 private:
  std::span<const float> values_;
  std::size_t rows_;
  std::size_t cols_;
};

bool is_loaded(const ForceField& field, std::size_t pillar) {
  return (field.status[pillar] & PF_STATUS_PRESSED) != 0;
}

/// A component of the force without the leak of the pillars around, as in
/// kernels/frame/correct_forces.cl.
std::vector<float> unleaked(const std::vector<float>& plane, const ForceField& field,
                            const maths::Stages& stages) {
  const PlaneView from(plane, field);
  std::vector<float> to(plane.size());
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t col = 0; col < field.cols; ++col) {
      if (!is_loaded(field, row * field.cols + col)) continue;
      const float edges = (from.at(row, col - 1) + from.at(row, col + 1)) +
                          (from.at(row - 1, col) + from.at(row + 1, col));
      const float corners = (from.at(row - 1, col - 1) + from.at(row - 1, col + 1)) +
                            (from.at(row + 1, col - 1) + from.at(row + 1, col + 1));
      to[row * field.cols + col] =
          maths::pillar_without_leak(from.at(row, col), edges, corners, stages.pillar_leak_self,
                                     stages.pillar_leak_edge, stages.pillar_leak_corner);
    }
  }
  return to;
}

maths::Solution solution_at(const ForceField& field, std::size_t index, bool uncertainty) {
  maths::Solution solution{};
  solution.status = field.status[index];
#define PF_LOAD(name, unit, value) solution.value = field.name[index];
  PF_FORCE_PLANES(PF_LOAD)
#undef PF_LOAD
  if (!uncertainty) return solution;
#define PF_LOAD(name, unit, value) solution.value = field.uncertainty[Uncertainty::name][index];
  PF_UNCERTAINTY_PLANES(PF_LOAD)
#undef PF_LOAD
  return solution;
}

/// The mean ratio of 3 x 3 pillars along an axis, as in kernels/frame/correct_forces.cl.
maths::ShearRatio mean_of_ratios(const std::vector<maths::WeightedRatios>& ratios,
                                 maths::WeightedRatio maths::WeightedRatios::*axis,
                                 const ForceField& field, std::size_t row, std::size_t col) {
  const auto at = [&](std::size_t r, std::size_t c) {
    return r < field.rows && c < field.cols ? ratios[r * field.cols + c].*axis
                                            : maths::WeightedRatio{};
  };
  const maths::ShearRatio own = at(row, col).own;
  const auto opposite = [&](std::size_t down, std::size_t right, float maths::WeightedRatio::*by) {
    const maths::WeightedRatio before = at(row - down, col - right);
    const maths::WeightedRatio after = at(row + down, col + right);
    return maths::add_ratios(maths::ratio_part(own.value, before.own.value, before.*by),
                             maths::ratio_part(own.value, after.own.value, after.*by));
  };
  constexpr auto kBack = static_cast<std::size_t>(-1);
  constexpr auto kBeside = &maths::WeightedRatio::beside;
  constexpr auto kDiagonal = &maths::WeightedRatio::diagonal;
  return maths::mean_ratio(
      own, maths::add_ratios(
               maths::add_ratios(opposite(0, 1, kBeside), opposite(1, 0, kBeside)),
               maths::add_ratios(opposite(1, 1, kDiagonal), opposite(1, kBack, kDiagonal))));
}

/// Corrects solved forces by those of the pillars around, as kernels/frame/correct_forces.cl.
void correct_forces(const maths::Stages& stages, ForceField& field) {
  if (stages.pillar_leak) {
    for (auto* plane : {&field.shear_x, &field.shear_y, &field.normal}) {
      *plane = unleaked(*plane, field, stages);
    }
  }
  if (!stages.lean) return;
  std::vector<maths::WeightedRatios> ratios(field.normal.size());
  for (std::size_t index = 0; index < ratios.size(); ++index) {
    if (!is_loaded(field, index)) continue;
    const auto [x, y] = pillar_lean(field.view(), index);
    ratios[index] = maths::shear_ratios(solution_at(field, index, false).force, field.status[index],
                                        x, y, stages);
  }
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t col = 0; col < field.cols; ++col) {
      const std::size_t index = row * field.cols + col;
      if (!is_loaded(field, index)) continue;
      const maths::ShearRatios means = {
          mean_of_ratios(ratios, &maths::WeightedRatios::x, field, row, col),
          mean_of_ratios(ratios, &maths::WeightedRatios::y, field, row, col)};
      const maths::Solution before = solution_at(field, index, stages.uncertainty);
      const maths::Solution after = maths::correct_solution(before, means, stages);
      field.status[index] = static_cast<std::uint8_t>(after.status);
      store_solution(after, index, stages.uncertainty, field);
    }
  }
}

/// True if an element of the 3 x 3 quads around one is loaded; a quad has `side` x `side` elements.
bool is_touched(const ForceField& forces, std::size_t row, std::size_t col, std::size_t side) {
  const std::size_t last_row = std::min<std::size_t>(side * (row + 2), forces.rows);
  const std::size_t last_col = std::min<std::size_t>(side * (col + 2), forces.cols);
  int bits = 0;
  for (std::size_t r = row == 0 ? 0 : side * (row - 1); r < last_row; ++r) {
    for (std::size_t c = col == 0 ? 0 : side * (col - 1); c < last_col; ++c) {
      bits |= forces.status[r * forces.cols + c];
    }
  }
  return (bits & PF_STATUS_PRESSED) != 0;
}

}  // namespace

void follow_baseline_on_host(SolverPlan& plan, const FrameView& frame, const ForceField& forces,
                             SensorState& state) {
  check(frame, plan.skin, plan.sensel_type, "follow_baseline_on_host");
  if (forces.rows != plan.skin.element_rows() || forces.cols != plan.skin.element_cols()) {
    throw Error("follow_baseline_on_host",
                fmt::format("the forces are {} x {}", forces.rows, forces.cols),
                "give the forces of this frame");
  }
  if (plan.calibration.tare.empty()) plan.calibration.tare.resize(plan.skin.sensels());
  if (!state.drift) state.drift = std::make_shared<DriftFollower>(plan);
  const std::uint64_t index = state.drift->frames();
  const maths::Drift drift = state.drift->follow(frame);
  SenselReader sensel(plan, frame);
  const auto rate = static_cast<float>(baseline_turn_rate(plan));
  const auto interval = static_cast<std::uint64_t>(plan.baseline_interval);
  const std::size_t side = plan.skin.has_pillars() ? 1 : 2;
  const std::size_t rows = std::min<std::size_t>(frame.rows, 2 * std::size_t{quad_rows(plan.skin)});
  const std::size_t cols = std::min<std::size_t>(frame.cols, 2 * std::size_t{quad_cols(plan.skin)});
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t quad_row = row / 2;
    if (quad_row % interval != index % interval) continue;
    for (std::size_t col = 0; col < cols; ++col) {
      const std::size_t quad_col = col / 2;
      const bool untouched = !is_touched(forces, quad_row, quad_col, side);
      float& tare = plan.calibration.tare[row * frame.cols + col];
      const float shift =
          maths::drift_at(drift, static_cast<float>(quad_col), static_cast<float>(quad_row));
      tare = maths::follow_tare(tare, sensel.untared(row, col), untouched, rate, shift);
    }
  }
}

ForceField solve_pillars(const SolverPlan& plan, const FrameView& frame, SensorState& state) {
  ForceField field(plan.skin);
  QuadSolver solver(plan, frame, state, field);
  for (std::size_t row = 0; row < quad_rows(plan.skin); ++row) {
    for (std::size_t col = 0; col < quad_cols(plan.skin); ++col) solver.solve(row, col);
  }
  const SensorEffects& effects = plan.calibration.effects;
  if (effects.pillar_leak || effects.arm_mm) correct_forces(solver.stages(), field);
  return field;
}

}  // namespace pillarfield
