// Compiled with -O3 -march=native (bench/CMakeLists.txt).

#include "bench/baselines/double_loop.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <type_traits>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/pillar_maths.h"

namespace pillarfield::bench {
namespace {

namespace maths = double_precision;

constexpr std::size_t kResults = 2;
constexpr std::size_t kPieces = 32;  ///< of a frame
constexpr std::size_t kForcePlanes = 3;
constexpr std::size_t kAnglePlanes = 3;

/// What a loop is compiled for, as a kernel is.
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

/// The plan's numbers, and where the planes of its calibration are.
struct Constants {
  explicit Constants(const SolverPlan& plan)
      : threshold(plan.skin.threshold_counts),
        full_scale(plan.skin.full_scale_counts.value_or(0)),
        doubt(region_doubt(plan)),
        noise(reading_noise(plan)),
        segment_point(plan.segment_point),
        tare(plan.calibration.tare.data()),
        gain(plan.calibration.gain.data()),
        dead_zone(plan.calibration.dead_zone.data()),
        mask(plan.calibration.mask.data()) {
    const ForceScale exact = force_scale(plan.skin.counts_per_newton);
    scale = {exact.shear, exact.normal};
  }
  double threshold;
  double full_scale;
  double doubt;
  double noise;
  double segment_point;
  maths::ForceScale scale{};
  const float* tare;
  const float* gain;
  const float* dead_zone;
  const std::uint8_t* mask;
};

template <class Reading, Stages stages>
maths::Sensel sensel_at(const Constants& is, const Reading* readings, std::size_t at) {
  maths::Sensel sensel = maths::raw_sensel(static_cast<double>(readings[at]));
  if constexpr (std::is_same_v<Reading, float>) sensel = maths::reject_absurd(sensel, kMaxCounts);
  if constexpr (stages.calibration) sensel = maths::apply_mask(sensel, is.mask[at]);
  if constexpr (stages.saturation) sensel = maths::mark_saturated(sensel, is.full_scale);
  if constexpr (stages.calibration) {
    sensel = maths::subtract_tare(sensel, is.tare[at]);
    sensel = maths::apply_gain(sensel, is.gain[at]);
  }
  sensel = maths::classify(sensel, is.threshold);
  if constexpr (stages.calibration) sensel = maths::fill_dead_zone(sensel, is.dead_zone[at]);
  return sensel;
}

/// Where a pillar's results go, plane by plane.
class Store {
 public:
  explicit Store(DoubleLoop::Planes& planes) {
    for (std::size_t i = 0; i + 1 < planes.size(); ++i) {
      planes_.at(i) = planes[i].readings<float>().data();
    }
    status_ = planes.back().readings<std::uint8_t>().data();
  }

  template <class... Values>
  void planes_from(std::size_t plane, std::size_t pillar, Values... values) const {
    ((planes_[plane++][pillar] = static_cast<float>(values)), ...);
  }
  void status(std::size_t pillar, maths::Bits bits) const {
    status_[pillar] = static_cast<std::uint8_t>(bits);
  }

 private:
  std::array<float*, kForcePlanes + kAnglePlanes + kUncertaintyPlanes> planes_{};
  std::uint8_t* status_;
};

template <Stages stages>
void solve_uncertainty(const Constants& is, const std::array<std::size_t, 4>& sensels,
                       const maths::Pillar& pillar, const maths::Diagonals& diagonals,
                       const maths::ParitySum& sum, const maths::Direction& direction,
                       const Store& to, std::size_t index) {
  constexpr std::size_t kFirst = kForcePlanes + (stages.angles ? kAnglePlanes : 0);
  const auto noise = [&](std::size_t n) {
    return stages.calibration ? is.noise * is.gain[sensels[n]] : is.noise;
  };
  const maths::Force deviations = maths::force_deviations(
      pillar, diagonals, sum, {noise(0), noise(1), noise(2), noise(3)}, is.segment_point, is.scale);
  const maths::DirectionInterval ends =
      maths::direction_interval(pillar, diagonals, sum, direction, is.scale);
  to.planes_from(kFirst, index, deviations.shear_x, deviations.shear_y, deviations.normal,
                 ends.theta_low, ends.theta_high, ends.phi_low, ends.phi_high, ends.magnitude_low,
                 ends.magnitude_high);
}

template <class Reading, Stages stages>
void solve_pillar(const Constants& is, const Reading* readings,
                  const std::array<std::size_t, 4>& sensels, const Store& to, std::size_t index) {
  const auto sensel = [&](std::size_t n) {
    return sensel_at<Reading, stages>(is, readings, sensels[n]);
  };
  const maths::Pillar pillar = {sensel(0), sensel(1), sensel(2), sensel(3)};
  const maths::Diagonals diagonals = maths::pillar_diagonals(pillar);
  const maths::ParitySum sum = maths::parity_sum(diagonals, is.segment_point);
  const maths::Force force = stages.paper ? maths::paper_force(pillar, diagonals, sum, is.scale)
                                          : maths::direct_force(diagonals, sum, is.scale);
  to.planes_from(0, index, force.shear_x, force.shear_y, force.normal);
  to.status(index, maths::direct_status(pillar, diagonals, sum, is.doubt));
  if constexpr (stages.angles || stages.uncertainty) {
    const maths::Direction direction = maths::direction_of(force);
    if constexpr (stages.angles) {
      to.planes_from(kForcePlanes, index, direction.magnitude, direction.theta, direction.phi);
    }
    if constexpr (stages.uncertainty) {
      solve_uncertainty<stages>(is, sensels, pillar, diagonals, sum, direction, to, index);
    }
  }
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
    throw Error("loop in double", "the plan is of no variant", "take a plan of solve_variants()");
  }
  return found;
}

DoubleLoop::Planes planes_for(const SolverPlan& plan) {
  const std::size_t count =
      kForcePlanes + (plan.angles ? kAnglePlanes : 0) + (plan.uncertainty ? kUncertaintyPlanes : 0);
  DoubleLoop::Planes planes;
  for (std::size_t i = 0; i <= count; ++i) {
    const SenselType type = i < count ? SenselType::f32 : SenselType::u8;
    planes.emplace_back(type, plan.skin.pillar_rows(), plan.skin.pillar_cols());
  }
  return planes;
}

}  // namespace

DoubleLoop::DoubleLoop(const SolverPlan& plan, int threads)
    : plan_(&plan), solve_rows_(loop_for(plan)), team_(threads) {
  for (std::size_t i = 0; i < kResults; ++i) results_.push_back(planes_for(plan));
}

void DoubleLoop::run(const Frames& frames, int count) {
  for (int i = 0; i < count; ++i) static_cast<void>(solve(frames[solved_]));
}

ForceFieldView DoubleLoop::solve(const FrameView& frame) {
  Planes& to = results_[solved_++ % kResults];
  const std::size_t rows = plan_->skin.pillar_rows();
  std::atomic<std::size_t> next = 0;
  team_.run([&](int /*member*/) {
    for (std::size_t piece = next++; piece < kPieces; piece = next++) {
      solve_rows_(*plan_, frame.data, rows * piece / kPieces, rows * (piece + 1) / kPieces, to);
    }
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
