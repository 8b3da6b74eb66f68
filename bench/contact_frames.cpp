#include "bench/contact_frames.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bench/variants.h"
#include "pillarfield/simulator.h"

namespace pillarfield::bench {
namespace {

constexpr double kContactFraction = 0.05;  ///< of the skin
constexpr int kIndenters = 8;
constexpr double kLoadN = 600;
constexpr double kTravelMm = 30;
constexpr double kContactNoiseCounts = 0.5;
constexpr double kThresholdCounts = 2.5;

struct Motion {
  ContactMotion kind;
  double friction;
  double direction_deg;
};

constexpr Motion kMixed[kIndenters] = {
    {ContactMotion::press, 0, 0},           {ContactMotion::slide, 0.6, 20},
    {ContactMotion::partial_slip, 1.1, 75}, {ContactMotion::spin, 0.9, 0},
    {ContactMotion::press, 0, 0},           {ContactMotion::slide, 0.5, 200},
    {ContactMotion::partial_slip, 0.8, 10}, {ContactMotion::slide, 1.0, 130}};

/// At friction 1.7 two sensels are inactive in a fifth of the directions of a spin, in every pillar
/// of a slide along a row, and in none of a slide along a diagonal.
constexpr Motion kSlipping[kIndenters] = {
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::spin, 1.7, 0},   {ContactMotion::slide, 1.7, 5},
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::spin, 1.7, 0},   {ContactMotion::slide, 1.7, 40},
    {ContactMotion::spin, 1.7, 0}, {ContactMotion::slide, 1.7, 140}};

ClosedFormContact ball(int number, const Motion& motion, double size_mm) {
  const double cell_mm = size_mm / 4;
  const double x_mm = (number % 4 - 1.5) * cell_mm;
  const double y_mm = (number < 4 ? 1 : -1) * size_mm / 4;
  const double direction = motion.direction_deg * std::numbers::pi / 180;
  ClosedFormContact contact;
  contact.motion = motion.kind;
  contact.contact_radius_mm =
      size_mm * std::sqrt(kContactFraction / (kIndenters * std::numbers::pi));
  contact.reference_load_n = kLoadN;
  contact.friction = motion.friction;
  contact.direction_deg = motion.direction_deg;
  contact.tangential_ratio = motion.kind == ContactMotion::partial_slip ? 0.7 : 1;
  contact.path = {
      {0, x_mm, y_mm, kLoadN},
      {1, x_mm + kTravelMm * std::cos(direction), y_mm + kTravelMm * std::sin(direction), kLoadN}};
  return contact;
}

Scene scene_of(Indenters indenters, std::size_t frames) {
  Scene scene;
  scene.skin = bare_plan(kSquareMetre).skin;
  scene.skin.threshold_counts = kThresholdCounts;
  scene.sensor.noise_counts = kContactNoiseCounts;
  scene.sensor.adc_bits = 8;
  scene.rate_hz = static_cast<double>(frames);
  scene.frames = static_cast<std::uint32_t>(frames);
  std::vector<ClosedFormContact> contacts;
  contacts.reserve(kIndenters);
  const double size_mm = scene.skin.sensel_pitch_mm.row_mm * scene.skin.rows;
  for (int i = 0; i < kIndenters; ++i) {
    contacts.push_back(ball(i, indenters == Indenters::mixed ? kMixed[i] : kSlipping[i], size_mm));
  }
  scene.load = std::move(contacts);
  return scene;
}

SolverPlan plan_of(const Scene& scene) {
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = SenselType::u8;
  set_solver(plan, scene);
  plan.estimator = Estimator::direct;
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

ContactFrames::ContactFrames(Indenters indenters, std::size_t count)
    : plan_(plan_of(scene_of(indenters, count))), frames_(render(scene_of(indenters, count))) {}

}  // namespace pillarfield::bench
