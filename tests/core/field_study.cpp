#include "field_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "core/field_estimate.h"
#include "core/host_solve.h"
#include "core/ideal_readings.h"
#include "core/sensor.h"
#include "pillarfield/scene.h"
#include "pillarfield/status.h"

namespace pillarfield::field_study {
namespace {

constexpr double kCountsPerNewton = 320;
constexpr double kBand = 1.96;  // standard deviations of a normal error hold 95 %

pillarfield::Scene sensor_scene(const Scene& scene) {
  pillarfield::Scene made;
  made.skin.rows = 2 * scene.loads->rows;
  made.skin.cols = 2 * scene.loads->cols;
  made.skin.counts_per_newton = kCountsPerNewton;
  made.skin.threshold_counts = 4 * scene.noise_counts;
  made.sensor.noise_counts = scene.noise_counts;
  made.uncertainty = true;
  made.seed = scene.seed;
  return made;
}

SolverPlan direct_plan(const Scene& scene) {
  const pillarfield::Scene made = sensor_scene(scene);
  SolverPlan plan;
  plan.skin = made.skin;
  plan.sensel_type = SenselType::f32;
  set_solver(plan, made);
  plan.segment_point = 0.5;  // the middle, which the study compares with
  return plan;
}

std::vector<std::size_t> open_pillars(const ForceField& direct) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < direct.pillars(); ++i) {
    const bool ambiguous = (direct.status[i] & status::kAmbiguous) != 0;
    if (ambiguous && region_of(direct.status[i]) == Region::three) open.push_back(i);
  }
  return open;
}

bool is_settled(std::uint8_t status) {
  const Region region = region_of(status);
  return region == Region::one || region == Region::two;
}

/// Whether a pillar is as the direct solve left it.
bool is_same(const ForceField& a, const ForceField& b, std::size_t i) {
  return a.shear_x[i] == b.shear_x[i] && a.shear_y[i] == b.shear_y[i] &&
         a.normal[i] == b.normal[i] && a.status[i] == b.status[i];
}

/// The model's readings of two rows of sensels, those of one row of pillars.
struct TwoRows {
  std::vector<double> upper;
  std::vector<double> lower;
};

TwoRows readings_of_row(const ForceField& truth, std::uint32_t row, double share) {
  TwoRows rows;
  for (std::uint32_t col = 0; col < truth.cols; ++col) {
    const std::size_t i = std::size_t{row} * truth.cols + col;
    const auto v = ideal_readings(
        {share * truth.shear_x[i], share * truth.shear_y[i], truth.normal[i]}, kCountsPerNewton);
    rows.upper.insert(rows.upper.end(), {v.v2, v.v1});
    rows.lower.insert(rows.lower.end(), {v.v3, v.v4});
  }
  return rows;
}

double squared_error(const ForceField& solved, const ForceField& truth, std::size_t i) {
  const double x = double{solved.shear_x[i]} - truth.shear_x[i];
  const double y = double{solved.shear_y[i]} - truth.shear_y[i];
  const double z = double{solved.normal[i]} - truth.normal[i];
  return kCountsPerNewton * kCountsPerNewton * (x * x + y * y + z * z);
}

/// The one place where frames are solved one after the other, each with the help of that before.
ForceField solve_sequence(const SolverPlan& plan, const std::vector<FrameBuffer>& frames) {
  SolverPlan direct = plan;
  direct.estimator = Estimator::direct;
  HostFieldEstimator estimator(plan);
  ForceField solved;
  for (const FrameBuffer& frame : frames) {
    solved = solve_on_host(direct, frame.view());
    estimator.resolve(solved);
  }
  return solved;
}

}  // namespace

std::string Scene::name() const {
  return fmt::format("{}, mu {:.3g}, noise {:g}", contact_name, friction, noise_counts);
}

double Score::rms_counts() const {
  return open == 0 ? 0 : std::sqrt(squares / static_cast<double>(open));
}

double Score::coverage() const {
  return open == 0 ? 1 : static_cast<double>(covered) / static_cast<double>(open);
}

Score& Score::operator+=(const Score& other) {
  loaded += other.loaded;
  open += other.open;
  resolved += other.resolved;
  covered += other.covered;
  resolved_covered += other.resolved_covered;
  touched += other.touched;
  squares += other.squares;
  return *this;
}

double Segment::shear_x(double normal) const { return moves_in_y ? fixed : moving + rate * normal; }

double Segment::shear_y(double normal) const { return moves_in_y ? moving + rate * normal : fixed; }

double Segment::theta_midpoint() const {
  // |shear|² = fixed² + (|moving| − √2 N)² = (N tan θ)², solved for N without cancellation.
  const double theta_low =
      std::atan2(std::hypot(shear_x(normal_high), shear_y(normal_high)), normal_high);
  const double slope = std::tan((theta_low + std::numbers::pi / 2) / 2);
  const double flat = fixed * fixed + moving * moving;
  const double turned = std::numbers::sqrt2 * std::abs(moving);
  return flat / (turned + std::sqrt(turned * turned + (slope * slope - 2) * flat));
}

double Segment::nearest(double shear_x, double shear_y, double normal) const {
  const double off = moving + rate * normal - (moves_in_y ? shear_y : shear_x);
  return normal - rate * off / (1 + rate * rate);
}

Segment segment_of(const ForceField& direct, std::size_t index) {
  // Shear to the right presses sensels 1 and 4, up 1 and 2. Where these read, a larger normal force
  // leaves less of it for the same readings: √2 times as much (D3, D6).
  const int usable = direct.status[index] & status::kUsable;
  Segment segment;
  segment.moves_in_y = usable == (status::kSensel1 | status::kSensel2) ||
                       usable == (status::kSensel3 | status::kSensel4);
  const bool positive = usable == (status::kSensel1 | status::kSensel2) ||
                        usable == (status::kSensel1 | status::kSensel4);
  segment.rate = positive ? -std::numbers::sqrt2 : std::numbers::sqrt2;
  const double x = direct.shear_x[index];
  const double y = direct.shear_y[index];
  const double middle = direct.normal[index];
  segment.fixed = segment.moves_in_y ? x : y;
  segment.moving = (segment.moves_in_y ? y : x) - segment.rate * middle;
  segment.normal_high = 2 * middle;
  return segment;
}

Observed::Observed(const Scene& scene)
    : scene_(scene),
      plan_(direct_plan(scene)),
      truth_(truth_of(*scene.loads, scene.friction, kCountsPerNewton)),
      frame_(read(1, 0)),
      direct_(solve_on_host(plan_, frame_.view())),
      open_(open_pillars(direct_)) {}

FrameBuffer Observed::read(double share, std::uint64_t index) const {
  const Sensor sensor(sensor_scene(scene_));
  FrameBuffer raw(SenselType::f32, plan_.skin.rows, plan_.skin.cols);
  for (std::uint32_t row = 0; row < truth_.rows; ++row) {
    TwoRows rows = readings_of_row(truth_, row, share);
    sensor.read_row(index, 2 * row, rows.upper, raw);
    sensor.read_row(index, 2 * row + 1, rows.lower, raw);
  }
  return raw;
}

std::vector<FrameBuffer> Observed::frames(int count) const {
  std::vector<FrameBuffer> all;
  for (int i = 1; i <= count; ++i) {
    all.push_back(read(static_cast<double>(i) / count, static_cast<std::uint64_t>(count - i)));
  }
  return all;
}

ForceField Observed::with_normals(
    const std::function<double(const Segment&, std::size_t)>& normal_of) const {
  ForceField field = direct_;
  for (const std::size_t i : open_) {
    const Segment segment = segment_of(direct_, i);
    const double normal = normal_of(segment, i);
    field.shear_x[i] = static_cast<float>(segment.shear_x(normal));
    field.shear_y[i] = static_cast<float>(segment.shear_y(normal));
    field.normal[i] = static_cast<float>(normal);
  }
  return field;
}

ForceField Observed::theta_midpoint() const {
  return with_normals([](const Segment& segment, std::size_t) { return segment.theta_midpoint(); });
}

ForceField Observed::nearest() const {
  return with_normals([&](const Segment& segment, std::size_t i) {
    return segment.nearest(truth_.shear_x[i], truth_.shear_y[i], truth_.normal[i]);
  });
}

bool Observed::covers(const ForceField& solved, std::size_t i) const {
  const double normal = truth_.normal[i];
  if ((solved.status[i] & status::kFromNeighbours) != 0) {
    const double deviation = solved.uncertainty[Uncertainty::normal][i];
    return std::abs(solved.normal[i] - normal) <= kBand * deviation;
  }
  // The upper end is twice the middle, and the noise of a reading over 2k is its deviation.
  const double deviation = scene_.noise_counts / (2 * kCountsPerNewton);
  return normal <= 2 * double{direct_.normal[i]} + kBand * deviation;
}

Score Observed::score(const ForceField& solved) const {
  Score score;
  for (std::size_t i = 0; i < direct_.pillars(); ++i) {
    if ((direct_.status[i] & status::kUsable) != 0) ++score.loaded;
    if (is_settled(direct_.status[i]) && !is_same(solved, direct_, i)) ++score.touched;
  }
  score.open = open_.size();
  for (const std::size_t i : open_) {
    const bool resolved = (solved.status[i] & status::kFromNeighbours) != 0;
    const bool covered = covers(solved, i);
    if (resolved) ++score.resolved;
    if (covered) ++score.covered;
    if (resolved && covered) ++score.resolved_covered;
    score.squares += squared_error(solved, truth_, i);
  }
  return score;
}

const std::vector<Method>& methods() {
  const auto evidence = [](bool shape, bool slip) {
    FieldEvidence made;
    made.shape = shape;
    made.slip = slip;
    return made;
  };
  static const std::vector<Method> all = {
      {"nothing said", evidence(true, true)},
      {"shape alone", evidence(true, false)},
      {"slip alone", evidence(false, true)},
      {"friction told", evidence(true, true), true},
      {"friction told, without shape", evidence(false, true), true},
      {"friction told, and that it slips", evidence(true, true), true, true},
      {"the frames before", evidence(true, true), false, false, true},
      {"the frames before alone", evidence(false, false), false, false, true},
      {"all of it", evidence(true, true), true, true, true},
  };
  return all;
}

SolverPlan plan_of(const Scene& scene, const Observed& observed, const Method& method) {
  SolverPlan plan = observed.plan();
  plan.estimator = Estimator::field;
  plan.field = method.evidence;
  if (method.told_friction) plan.field.friction = scene.friction;
  plan.field.slips = method.told_slip;
  plan.field.frames_close = method.sequence;
  return plan;
}

std::optional<ForceField> solve(const Scene& scene, const Observed& observed,
                                const Method& method) {
  if (method.told_slip && !slips(scene.motion())) return std::nullopt;
  const SolverPlan plan = plan_of(scene, observed, method);
  if (method.sequence) return solve_sequence(plan, observed.frames(kSequenceFrames));
  return solve_on_host(plan, observed.frame().view());
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back([&] {
      for (std::size_t index = next++; index < count; index = next++) work(index);
    });
  }
}

}  // namespace pillarfield::field_study
