#include "pillarfield/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "simulation/body/body_history.h"
#include "simulation/closed_form/contact_traction.h"
#include "simulation/closed_form/direction_sweep.h"
#include "simulation/ideal_readings.h"
#include "simulation/scene/scene_limits.h"
#include "simulation/sensor.h"

namespace pillarfield {
namespace {

Scene checked(Scene scene) {
  if (!scene.skin.full_scale_counts) scene.skin.full_scale_counts = full_scale_of(scene.sensor);
  check(scene, "scene");
  return scene;
}

void clear(ForceField& field) {
  for (std::vector<float>* plane : {&field.shear_x, &field.shear_y, &field.normal}) {
    std::fill(plane->begin(), plane->end(), 0.0F);
  }
  std::fill(field.status.begin(), field.status.end(), std::uint8_t{0});
}

void add_forces(const BodyForces& forces, ForceField& field) {
  const auto add = [](double force_n, float& to) { to = static_cast<float>(to + force_n); };
  for (const BodyForce& force : forces) {
    add(force.shear_x, field.shear_x[force.pillar]);
    add(force.shear_y, field.shear_y[force.pillar]);
    add(force.normal, field.normal[force.pillar]);
  }
}

/// V of the two sensel rows under a row of pillars, counts.
struct SignalRows {
  explicit SignalRows(std::size_t cols) : upper(cols), lower(cols) {}
  std::vector<double> upper;
  std::vector<double> lower;
};

/// Fills the signals and the status bytes of one row of pillars.
void read_pillars(std::uint32_t row, double counts_per_newton, ForceField& truth,
                  SignalRows& signals) {
  std::fill(signals.upper.begin(), signals.upper.end(), 0.0);
  std::fill(signals.lower.begin(), signals.lower.end(), 0.0);
  const std::size_t first = std::size_t{row} * truth.cols;
  for (std::size_t col = 0; col < truth.cols; ++col) {
    const std::size_t pillar = first + col;
    const double_precision::Force force = {truth.shear_x[pillar], truth.shear_y[pillar],
                                           truth.normal[pillar]};
    if (force.normal == 0 && force.shear_x == 0 && force.shear_y == 0) continue;
    const double_precision::Readings v = ideal_readings(force, counts_per_newton);
    truth.status[pillar] = usable_bits(v);
    signals.upper[2 * col] = v.v2;
    signals.upper[2 * col + 1] = v.v1;
    signals.lower[2 * col] = v.v3;
    signals.lower[2 * col + 1] = v.v4;
  }
}

}  // namespace

struct Simulator::State {
  explicit State(Scene given) : scene(checked(std::move(given))), sensor(scene) {
    if (const DirectionSweep* sweep = std::get_if<DirectionSweep>(&scene.load))
      sweep_truth = direction_sweep_forces(*sweep);
    for (std::size_t number = 0; number < scene.bodies.size(); ++number) {
      bodies.push_back(std::make_unique<BodyHistory>(scene, number));
    }
  }

  /// Fills the three planes of force, and clears the status bytes.
  void load(std::uint64_t index, ForceField& truth) const {
    if (std::holds_alternative<DirectionSweep>(scene.load)) {
      truth = sweep_truth;
      return;
    }
    clear(truth);
    for (const Contact& contact : std::get<std::vector<Contact>>(scene.load)) {
      add_contact(contact, state_at(contact, time_of(index)), scene.skin.pillar_pitch_mm(), truth);
    }
    for (const std::unique_ptr<BodyHistory>& body : bodies) add_forces(*body->forces(index), truth);
  }

  [[nodiscard]] double time_of(std::uint64_t index) const {
    return static_cast<double>(index) / scene.rate_hz;
  }

  void check_buffers(const FrameView& raw, const ForceField& truth) const {
    const Skin& skin = scene.skin;
    if (raw.rows != skin.rows || raw.cols != skin.cols || raw.type != sensor.sensel_type()) {
      throw Error("frame",
                  fmt::format("has {} x {} readings of {}", raw.rows, raw.cols, name_of(raw.type)),
                  fmt::format("the scene needs {} x {} of {}", skin.rows, skin.cols,
                              name_of(sensor.sensel_type())));
    }
    if (truth.rows != skin.pillar_rows() || truth.cols != skin.pillar_cols()) {
      throw Error("truth", fmt::format("has {} x {} pillars", truth.rows, truth.cols),
                  fmt::format("the scene needs {} x {}", skin.pillar_rows(), skin.pillar_cols()));
    }
  }

  Scene scene;
  Sensor sensor;
  ForceField sweep_truth;  ///< empty where the load is not a sweep
  std::vector<std::unique_ptr<BodyHistory>> bodies;
};

Simulator::Simulator(Scene scene) : state_(std::make_unique<State>(std::move(scene))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const Scene& Simulator::scene() const { return state_->scene; }
SenselType Simulator::sensel_type() const { return state_->sensor.sensel_type(); }
const Calibration& Simulator::calibration() const { return state_->sensor.calibration(); }

double Simulator::time_of(std::uint64_t index) const { return state_->time_of(index); }

void Simulator::render(std::uint64_t index, FrameBuffer& raw, ForceField& truth) const {
  state_->check_buffers(raw.view(), truth);
  state_->load(index, truth);
  const Skin& skin = state_->scene.skin;
  SignalRows signals(skin.cols);
  for (std::uint32_t row = 0; row < skin.pillar_rows(); ++row) {
    read_pillars(row, skin.counts_per_newton, truth, signals);
    state_->sensor.read_row(index, 2 * row, signals.upper, raw);
    state_->sensor.read_row(index, 2 * row + 1, signals.lower, raw);
  }
  if (skin.rows % 2 != 0) {
    std::fill(signals.upper.begin(), signals.upper.end(), 0.0);
    state_->sensor.read_row(index, skin.rows - 1, signals.upper, raw);
  }
}

}  // namespace pillarfield
