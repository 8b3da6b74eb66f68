#include "bench/body_frames.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bench/solve_variant.h"
#include "bench/variants.h"
#include "pillarfield/simulator.h"

namespace pillarfield::bench {
namespace {

constexpr double kShare = 0.05;  ///< of the skin in contact
constexpr int kBodies = 8;
constexpr double kLoadN = 600;
constexpr double kWayMm = 30;

/// How a body moves: `turn_deg` is where it is dragged to.
struct Motion {
  ContactMotion kind;
  double friction;
  double turn_deg;
};

constexpr Motion kMixed[kBodies] = {
    {ContactMotion::press, 0, 0},           {ContactMotion::slide, 0.6, 20},
    {ContactMotion::partial_slip, 1.1, 75}, {ContactMotion::spin, 0.9, 0},
    {ContactMotion::press, 0, 0},           {ContactMotion::slide, 0.5, 200},
    {ContactMotion::partial_slip, 0.8, 10}, {ContactMotion::slide, 1.0, 130}};

/// Under a spin at such a friction, a fifth of the directions lift two sensels; dragged along a row
/// all do, along a diagonal none.
constexpr Motion kSlipping[kBodies] = {
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::spin, 1.7, 0},   {ContactMotion::slide, 1.7, 5},
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::spin, 1.7, 0},   {ContactMotion::slide, 1.7, 40},
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::slide, 1.7, 140}};

Contact ball(int number, const Motion& motion, double size_mm) {
  const double cell_mm = size_mm / 4;
  const double x_mm = (number % 4 - 1.5) * cell_mm;
  const double y_mm = (number < 4 ? 1 : -1) * size_mm / 4;
  const double turn = motion.turn_deg * std::numbers::pi / 180;
  Contact contact;
  contact.motion = motion.kind;
  contact.contact_radius_mm = size_mm * std::sqrt(kShare / (kBodies * std::numbers::pi));
  contact.reference_load_n = kLoadN;
  contact.friction = motion.friction;
  contact.direction_deg = motion.turn_deg;
  contact.tangential_ratio = motion.kind == ContactMotion::partial_slip ? 0.7 : 1;
  contact.path = {{0, x_mm, y_mm, kLoadN},
                  {1, x_mm + kWayMm * std::cos(turn), y_mm + kWayMm * std::sin(turn), kLoadN}};
  return contact;
}

Scene scene_of(Bodies bodies, std::size_t frames) {
  Scene scene;
  scene.skin = bare_plan(kSquareMetre).skin;
  scene.skin.threshold_counts = kSensorThresholdCounts;
  scene.sensor.noise_counts = kSensorNoiseCounts;
  scene.sensor.adc_bits = 8;
  scene.rate_hz = static_cast<double>(frames);
  scene.frames = static_cast<std::uint32_t>(frames);
  std::vector<Contact> contacts;
  contacts.reserve(kBodies);
  const double size_mm = scene.skin.sensel_pitch_mm * scene.skin.rows;
  for (int i = 0; i < kBodies; ++i) {
    contacts.push_back(ball(i, bodies == Bodies::mixed ? kMixed[i] : kSlipping[i], size_mm));
  }
  scene.load = std::move(contacts);
  return scene;
}

SolverPlan plan_of(const Scene& scene) {
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = SenselType::u8;
  set_solver(plan, scene);
  return plan;
}

std::vector<FrameBuffer> render(const Scene& scene) {
  const Simulator simulator(scene);
  ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  std::vector<FrameBuffer> frames;
  for (std::uint32_t i = 0; i < scene.frames; ++i) {
    simulator.render(i, frames.emplace_back(SenselType::u8, scene.skin.rows, scene.skin.cols),
                     truth);
  }
  return frames;
}

}  // namespace

BodyFrames::BodyFrames(Bodies bodies, std::size_t count)
    : plan_(plan_of(scene_of(bodies, count))),
      frames_(plan_.skin, render(scene_of(bodies, count))) {}

}  // namespace pillarfield::bench
