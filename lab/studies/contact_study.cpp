#include "lab/studies/contact_study.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/component_ends.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "simulation/ideal_readings.h"
#include "simulation/scene/scene_limits.h"
#include "simulation/sensor.h"

namespace pillarfield::contact_study {
namespace {

constexpr double kNormal95 = 1.96;  // standard deviations of a normal error hold 95 %

double_precision::Force force_of(const ForceField& field, std::size_t i) {
  return {field.shear_x[i], field.shear_y[i], field.normal[i]};
}

/// Reads one frame.
FrameBuffer read_frame(const Scene& scene, const Sensor& sensor, const ForceField& truth,
                       std::uint64_t index) {
  FrameBuffer raw(sensor.sensel_type(), scene.skin.rows, scene.skin.cols);
  std::vector<double> upper(scene.skin.cols);
  std::vector<double> lower(scene.skin.cols);
  for (std::uint32_t row = 0; row < truth.rows; ++row) {
    for (std::uint32_t col = 0; col < truth.cols; ++col) {
      const auto v = ideal_readings(force_of(truth, std::size_t{row} * truth.cols + col),
                                    scene.skin.counts_per_newton);
      upper[std::size_t{2} * col] = v.v2;
      upper[std::size_t{2} * col + 1] = v.v1;
      lower[std::size_t{2} * col] = v.v3;
      lower[std::size_t{2} * col + 1] = v.v4;
    }
    sensor.read_row(index, 2 * row, upper, raw);
    sensor.read_row(index, 2 * row + 1, lower, raw);
  }
  return raw;
}

std::vector<std::size_t> ambiguous_pillars(const ForceField& direct, const ForceField& truth) {
  std::vector<std::size_t> ambiguous;
  for (std::size_t i = 0; i < direct.elements(); ++i) {
    if (region_of(direct.status[i]) == Region::three && truth.normal[i] > 0) ambiguous.push_back(i);
  }
  return ambiguous;
}

double squared_error(const ForceField& solved, const ForceField& truth, std::size_t i) {
  const double x = double{solved.shear_x[i]} - truth.shear_x[i];
  const double y = double{solved.shear_y[i]} - truth.shear_y[i];
  const double z = double{solved.normal[i]} - truth.normal[i];
  return x * x + y * y + z * z;
}

double total_normal(const ForceField& field) {
  return std::accumulate(field.normal.begin(), field.normal.end(), 0.0);
}

double shear_of(const ForceField& field, std::size_t i) {
  return std::hypot(field.shear_x[i], field.shear_y[i]);
}

double magnitude_of(const ForceField& field, std::size_t i) {
  return std::hypot(field.shear_x[i], field.shear_y[i], field.normal[i]);
}

/// Whether a component lies between its stated ends.
bool is_between_ends(const ForceField& solved, ComponentEnd low, std::size_t pillar, double value) {
  const auto ends = component_ends(solved.view(), pillar, std::nullopt);
  const auto first = static_cast<std::size_t>(low);
  return ends[first] <= value && value <= ends[first + 1];
}

/// Whether a value lies in [low − margin, high + margin], up to single-precision rounding.
bool is_between(const ForceField& solved, Uncertainty low, Uncertainty high, std::size_t i,
                double value, double margin) {
  constexpr double kRounding = 1e-5;
  return value >= solved.uncertainty[low][i] * (1 - kRounding) - margin &&
         value <= solved.uncertainty[high][i] * (1 + kRounding) + margin;
}

/// Whether an angle lies on the widened arc counter-clockwise from low to high. A margin of NaN,
/// that of a force without shear, admits any phi.
bool is_on_arc(const ForceField& solved, std::size_t i, double phi, double margin) {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr double kRounding = 1e-5;
  if (!(margin < kTurn / 2)) return true;
  const double low = solved.uncertainty[Uncertainty::phi_low][i] - kRounding - margin;
  const double high = solved.uncertainty[Uncertainty::phi_high][i] + kRounding + margin;
  const auto positive = [](double angle) { return angle < 0 ? angle + kTurn : angle; };
  return positive(std::fmod(phi - low, kTurn)) <= positive(std::fmod(high - low, kTurn));
}

/// `pillars`, `used` and `slipping` of a contact's FrictionEstimate, at a median of 1.
FrictionEstimate usage_of(std::span<const ContactRun> runs, const ForceField& solved,
                          const ForceField& truth, double friction) {
  constexpr double kSlipping = 0.9;
  FrictionEstimate usage;
  double shear = 0;
  double normal = 0;
  double slipping = 0;
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::size_t i = std::size_t{run.row} * truth.cols + col;
      ++usage.pillars;
      shear += shear_of(solved, i);
      normal += solved.normal[i];
      if (shear_of(truth, i) > kSlipping * friction * truth.normal[i]) ++slipping;
    }
  }
  usage.used = normal > 0 ? shear / normal : 0;
  usage.slipping = slipping / static_cast<double>(usage.pillars);
  return usage;
}

}  // namespace

Recording read_forces(Scene scene, std::vector<ForceField> truth) {
  scene.skin.full_scale_counts = full_scale_of(scene.sensor);
  scene.uncertainty = true;
  const Sensor sensor(scene);
  Recording recording;
  recording.name = scene.title;
  recording.plan.skin = scene.skin;
  recording.plan.sensel_type = sensor.sensel_type();
  set_solver(recording.plan, scene);
  for (std::size_t frame = 0; frame < truth.size(); ++frame) {
    recording.frames.push_back(read_frame(scene, sensor, truth[frame], frame));
  }
  recording.truth = std::move(truth);
  return recording;
}

double largest_reading(std::span<const ForceField> truth) {
  double largest = 0;
  for (const ForceField& field : truth) {
    for (std::size_t i = 0; i < field.elements(); ++i) {
      const auto v = ideal_readings(force_of(field, i), 1);
      largest = std::max({largest, v.v1, v.v2, v.v3, v.v4});
    }
  }
  return largest;
}

std::vector<ForceField> solve(const Recording& recording, const SolverPlan& plan) {
  SolverPlan of_frame = plan;
  std::optional<ContactEstimator> estimator;
  if (plan.estimator == Estimator::contact) {
    of_frame.estimator = Estimator::direct;
    estimator.emplace(plan);
  }
  if (plan.estimator == Estimator::paper) of_frame.uncertainty = false;
  std::vector<ForceField> solved;
  for (const FrameBuffer& frame : recording.frames) {
    solved.push_back(solve_on_host(of_frame, frame.view()));
    if (estimator) estimator->resolve(solved.back());
  }
  return solved;
}

std::vector<FrictionEstimate> friction_estimates(const Recording& recording) {
  SolverPlan plan = recording.plan;
  plan.estimator = Estimator::contact;
  ContactEstimator estimator(plan);
  std::vector<FrictionEstimate> estimates;
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    ForceField solved = solve_on_host(recording.plan, recording.frames[frame].view());
    estimator.resolve(solved);
    for (std::uint32_t contact = 0; contact < estimator.contacts().contacts(); ++contact) {
      const ContactFriction& friction = estimator.friction()[contact];
      FrictionEstimate one = usage_of(estimator.contacts().runs(contact), solved,
                                      recording.truth[frame], recording.friction);
      one.median = friction.median;
      one.spread = friction.spread;
      one.used /= friction.median;
      estimates.push_back(one);
    }
  }
  return estimates;
}

double Segment::shear_x(double normal) const { return moves_in_y ? fixed : moving + rate * normal; }

double Segment::shear_y(double normal) const { return moves_in_y ? moving + rate * normal : fixed; }

double Segment::nearest(double shear_x, double shear_y, double normal) const {
  const double off = moving + rate * normal - (moves_in_y ? shear_y : shear_x);
  return normal - rate * off / (1 + rate * rate);
}

Segment segment_of(const ForceField& direct, std::size_t index, double segment_point) {
  // Shear to the right loads sensels 1 and 4, shear up 1 and 2. For given readings of these, shear
  // falls by √2 times the increase of the normal force (D3, D6).
  const int usable = direct.status[index] & status::kUsable;
  Segment segment;
  segment.moves_in_y = usable == (status::kSensel1 | status::kSensel2) ||
                       usable == (status::kSensel3 | status::kSensel4);
  const bool positive = usable == (status::kSensel1 | status::kSensel2) ||
                        usable == (status::kSensel1 | status::kSensel4);
  segment.rate = positive ? -std::numbers::sqrt2 : std::numbers::sqrt2;
  const double x = direct.shear_x[index];
  const double y = direct.shear_y[index];
  const double normal = direct.normal[index];
  segment.fixed = segment.moves_in_y ? x : y;
  segment.moving = (segment.moves_in_y ? y : x) - segment.rate * normal;
  segment.normal_high = normal / segment_point;
  return segment;
}

const std::array<Interval, kIntervals>& intervals() {
  using U = Uncertainty;
  using Field = ForceField;
  static constexpr std::array<Interval, kIntervals> kAll = {{
      {"shear_x",
       [](const Field& solved, const Field& truth, std::size_t i, double) {
         return is_between_ends(solved, ComponentEnd::shear_x_low, i, truth.shear_x[i]);
       }},
      {"shear_y",
       [](const Field& solved, const Field& truth, std::size_t i, double) {
         return is_between_ends(solved, ComponentEnd::shear_y_low, i, truth.shear_y[i]);
       }},
      {"normal",
       [](const Field& solved, const Field& truth, std::size_t i, double) {
         return is_between_ends(solved, ComponentEnd::normal_low, i, truth.normal[i]);
       }},
      {"magnitude",
       [](const Field& solved, const Field& truth, std::size_t i, double noise_n) {
         return is_between(solved, U::magnitude_low, U::magnitude_high, i, magnitude_of(truth, i),
                           kNormal95 * noise_n);
       }},
      {"theta",
       [](const Field& solved, const Field& truth, std::size_t i, double noise_n) {
         return is_between(solved, U::theta_low, U::theta_high, i,
                           std::atan2(shear_of(truth, i), truth.normal[i]),
                           kNormal95 * noise_n / magnitude_of(truth, i));
       }},
      {"phi",
       [](const Field& solved, const Field& truth, std::size_t i, double noise_n) {
         return is_on_arc(solved, i, std::atan2(-truth.shear_y[i], -truth.shear_x[i]),
                          kNormal95 * noise_n / shear_of(truth, i));
       }},
  }};
  return kAll;
}

double Score::rms_counts() const {
  return ambiguous == 0 ? 0 : std::sqrt(squares / static_cast<double>(ambiguous));
}

double Score::coverage(std::size_t interval) const {
  return ambiguous == 0 ? 1
                        : static_cast<double>(held.at(interval)) / static_cast<double>(ambiguous);
}

double Score::total_bias() const {
  return frames == 0 ? 0 : total_errors / static_cast<double>(frames);
}

double Score::total_rms() const {
  return frames == 0 ? 0 : std::sqrt(total_squares / static_cast<double>(frames));
}

Score& Score::operator+=(const Score& other) {
  loaded += other.loaded;
  ambiguous += other.ambiguous;
  squares += other.squares;
  for (std::size_t k = 0; k < kIntervals; ++k) {
    held[k] += other.held[k];
    held_with_noise[k] += other.held_with_noise[k];
  }
  frames += other.frames;
  total_errors += other.total_errors;
  total_squares += other.total_squares;
  return *this;
}

Evaluation::Evaluation(const Recording& recording)
    : recording_(recording), direct_(solve(recording, recording.plan)) {
  for (std::size_t frame = 0; frame < direct_.size(); ++frame) {
    ambiguous_.push_back(ambiguous_pillars(direct_[frame], recording.truth[frame]));
  }
}

std::vector<ForceField> Evaluation::nearest() const {
  std::vector<ForceField> nearest = direct_;
  for (std::size_t frame = 0; frame < nearest.size(); ++frame) {
    const ForceField& truth = recording_.truth[frame];
    for (const std::size_t i : ambiguous_[frame]) {
      const Segment segment = segment_of(direct_[frame], i, recording_.plan.segment_point);
      const double normal = segment.nearest(truth.shear_x[i], truth.shear_y[i], truth.normal[i]);
      nearest[frame].shear_x[i] = static_cast<float>(segment.shear_x(normal));
      nearest[frame].shear_y[i] = static_cast<float>(segment.shear_y(normal));
      nearest[frame].normal[i] = static_cast<float>(normal);
    }
  }
  return nearest;
}

Score Evaluation::score(const std::vector<ForceField>& solved) const {
  const double counts_per_newton = recording_.plan.skin.counts_per_newton;
  const double noise_n = reading_noise(recording_.plan) / counts_per_newton;
  Score score;
  for (std::size_t frame = 0; frame < solved.size(); ++frame) {
    const ForceField& truth = recording_.truth[frame];
    score.loaded += static_cast<std::size_t>(
        std::count_if(direct_[frame].status.begin(), direct_[frame].status.end(),
                      [](std::uint8_t bits) { return (bits & status::kUsable) != 0; }));
    score.ambiguous += ambiguous_[frame].size();
    const bool states = !solved[frame].uncertainty[Uncertainty::normal].empty();
    for (const std::size_t i : ambiguous_[frame]) {
      score.squares +=
          counts_per_newton * counts_per_newton * squared_error(solved[frame], truth, i);
      for (std::size_t k = 0; states && k < kIntervals; ++k) {
        if (intervals()[k].holds(solved[frame], truth, i, 0)) ++score.held[k];
        if (intervals()[k].holds(solved[frame], truth, i, noise_n)) ++score.held_with_noise[k];
      }
    }
    const double load = total_normal(truth);
    if (load <= 0) continue;
    const double error = total_normal(solved[frame]) / load - 1;
    ++score.frames;
    score.total_errors += error;
    score.total_squares += error * error;
  }
  return score;
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads.emplace_back([&] {
        try {
          for (std::size_t index = next++; index < count; index = next++) work(index);
        } catch (...) {
          const std::scoped_lock lock(mutex);
          failure = std::current_exception();
          next = count;
        }
      });
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pillarfield::contact_study
