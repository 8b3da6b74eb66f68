// Compiled with -O3 -march=native (bench/CMakeLists.txt).

#include "bench/baselines/double_loop.h"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/pillar_maths.h"
#include "solve/plan_constants.h"
#include "solve/result_planes.h"

namespace pillarfield::bench {
namespace {

namespace maths = double_precision;

constexpr std::size_t kResults = 2;
constexpr std::size_t kPieces = 32;  ///< of a frame

/// Stages of a compiled loop.
struct Stages {
  bool paper = false;
  bool calibration = false;
  bool saturation = false;
  bool angles = false;
  bool uncertainty = false;

  friend constexpr bool operator==(const Stages&, const Stages&) = default;
};

constexpr std::array kCompiled = {
    Stages{},
    Stages{.calibration = true},
    Stages{.angles = true},
    Stages{.uncertainty = true},
    Stages{.calibration = true, .saturation = true, .angles = true, .uncertainty = true},
    Stages{.paper = true},
    Stages{.paper = true, .calibration = true},
    Stages{.paper = true, .angles = true},
};

/// The plan's constants and calibration planes.
struct Constants {
  explicit Constants(const SolverPlan& plan)
      : stages(plan_constants<maths::Stages>(plan)),
        noise(reading_noise(plan)),
        tare(plan.calibration.tare.data()),
        gain(plan.calibration.gain.data()),
        dead_zone(plan.calibration.dead_zone.data()),
        mask(plan.calibration.mask.data()) {}
  maths::Stages stages;
  double noise;
  const float* tare;
  const float* gain;
  const float* dead_zone;
  const std::uint8_t* mask;
};

/// The plan's constants, with the stages of the compiled loop.
template <class Reading, Stages compiled>
maths::Stages stages_of(const Constants& is) {
  maths::Stages stages = is.stages;
  stages.range = std::is_same_v<Reading, float>;
  stages.mask = stages.tare = stages.gain = stages.dead_zone = compiled.calibration;
  stages.saturation = compiled.saturation;
  stages.paper = compiled.paper;
  stages.angles = compiled.angles;
  stages.uncertainty = compiled.uncertainty;
  stages.power_law = stages.parity_test = false;
  return stages;
}

template <Stages compiled>
maths::Correction correction_at(const Constants& is, std::size_t at) {
  if constexpr (!compiled.calibration) return {};
  return {is.tare[at], is.gain[at], is.dead_zone[at], static_cast<double>(is.mask[at]), {}};
}

/// Writes a pillar's results, plane by plane.
class Store {
 public:
  explicit Store(DoubleLoop::Planes& planes) {
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
      planes_.at(i) = planes[i].readings<float>().data();
    }
    status_ = planes.back().readings<std::uint8_t>().data();
  }

  void plane(std::size_t which, std::size_t pillar, double value) const {
    planes_[which][pillar] = static_cast<float>(value);
  }
  void status(std::size_t pillar, maths::Bits bits) const {
    status_[pillar] = static_cast<std::uint8_t>(bits);
  }

 private:
  std::array<float*, kSolvedPlanes> planes_{};
  std::uint8_t* status_;
};

template <class Reading, Stages compiled>
void solve_pillar(const Constants& is, const Reading* readings,
                  const std::array<std::size_t, 4>& sensels, const Store& to, std::size_t index) {
  const maths::Stages stages = stages_of<Reading, compiled>(is);
  const auto sensel = [&](std::size_t n) {
    return maths::correct_sensel(static_cast<double>(readings[sensels[n]]),
                                 correction_at<compiled>(is, sensels[n]), stages);
  };
  const auto noise = [&](std::size_t n) {
    return compiled.calibration ? is.noise * is.gain[sensels[n]] : is.noise;
  };
  const maths::Solution solution =
      maths::solve_pillar({sensel(0), sensel(1), sensel(2), sensel(3)},
                          {noise(0), noise(1), noise(2), noise(3)}, stages);
  to.status(index, solution.status);
  std::size_t plane = 0;
#define PF_STORE(name, unit, value) to.plane(plane++, index, solution.value);
  PF_FORCE_PLANES(PF_STORE)
  if constexpr (compiled.angles) {
    PF_ANGLE_PLANES(PF_STORE)
  }
  if constexpr (compiled.uncertainty) {
    PF_UNCERTAINTY_PLANES(PF_STORE)
  }
#undef PF_STORE
}

template <class Reading, Stages stages>
void solve_rows(const SolverPlan& plan, const void* data, std::size_t first, std::size_t last,
                DoubleLoop::Planes& to) {
  const Constants constants(plan);
  const Store store(to);
  const auto* const readings = static_cast<const Reading*>(data);
  const std::size_t cols = plan.skin.cols;
  const std::size_t pillar_cols = plan.skin.pillar_cols();
  for (std::size_t row = first; row < last; ++row) {
    for (std::size_t col = 0; col < pillar_cols; ++col) {
      const std::size_t left = 2 * row * cols + 2 * col;
      solve_pillar<Reading, stages>(constants, readings,
                                    {left + 1, left, left + cols, left + cols + 1}, store,
                                    row * pillar_cols + col);
    }
  }
}

template <class Reading, std::size_t... places>
DoubleLoop::SolveRows find(const Stages& wanted, std::index_sequence<places...> /*sequence*/) {
  DoubleLoop::SolveRows found = nullptr;
  ((found = kCompiled[places] == wanted ? solve_rows<Reading, kCompiled[places]> : found), ...);
  return found;
}

DoubleLoop::SolveRows loop_for(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  const Stages wanted = {.paper = plan.estimator == Estimator::paper,
                         .calibration = !calibration.empty(),
                         .saturation = plan.skin.full_scale_counts.has_value(),
                         .angles = plan.angles,
                         .uncertainty = plan.uncertainty};
  const bool whole =
      calibration.empty() || (!calibration.tare.empty() && !calibration.gain.empty() &&
                              !calibration.dead_zone.empty() && !calibration.mask.empty());
  constexpr auto kPlaces = std::make_index_sequence<kCompiled.size()>();
  DoubleLoop::SolveRows found = nullptr;
  if (whole && !plan.baseline_rate && !plan.parity_tolerance_counts && !plan.skin.power_law) {
    found = plan.sensel_type == SenselType::u8    ? find<std::uint8_t>(wanted, kPlaces)
            : plan.sensel_type == SenselType::u16 ? find<std::uint16_t>(wanted, kPlaces)
                                                  : find<float>(wanted, kPlaces);
  }
  if (found == nullptr) {
    throw Error("loop in double", "the plan is not that of a variant",
                "use a plan of solve_variants()");
  }
  return found;
}

DoubleLoop::Planes planes_for(const SolverPlan& plan) {
  const auto count = static_cast<std::size_t>(std::ranges::count_if(
      std::span(kResultPlanes).first<kSolvedPlanes>(),
      [&](const auto& plane) { return has_planes(plan.angles, plan.uncertainty, plane.set); }));
  DoubleLoop::Planes planes;
  for (std::size_t i = 0; i <= count; ++i) {
    const SenselType type = i < count ? SenselType::f32 : SenselType::u8;
    planes.emplace_back(type, plan.skin.pillar_rows(), plan.skin.pillar_cols());
  }
  return planes;
}

}  // namespace

DoubleLoop::DoubleLoop(const SolverPlan& plan, int threads)
    : plan_(&plan), solve_rows_(loop_for(plan)), pool_(static_cast<std::size_t>(threads)) {
  for (std::size_t i = 0; i < kResults; ++i) results_.push_back(planes_for(plan));
}

void DoubleLoop::run(const Frames& frames, int count) {
  for (int i = 0; i < count; ++i) static_cast<void>(solve(frames[solved_]));
}

ForceFieldView DoubleLoop::solve(const FrameView& frame) {
  Planes& to = results_[solved_++ % kResults];
  const std::size_t rows = plan_->skin.pillar_rows();
  pool_.run(kPieces, [&](std::size_t piece, std::size_t /*member*/) {
    solve_rows_(*plan_, frame.data, rows * piece / kPieces, rows * (piece + 1) / kPieces, to);
  });
  ForceFieldView view;
  view.rows = plan_->skin.pillar_rows();
  view.cols = plan_->skin.pillar_cols();
  view.shear_x = to[0].readings<float>();
  view.shear_y = to[1].readings<float>();
  view.normal = to[2].readings<float>();
  view.status = to.back().readings<std::uint8_t>();
  return view;
}

}  // namespace pillarfield::bench
