#include "lab/studies/coverage_study.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lab/studies/bound.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"

namespace pillarfield::coverage_study {
namespace {

/// A sensor with all imperfections that a calibration corrects, in whole counts.
Scene real_sensor(double noise_counts, std::uint64_t seed) {
  Scene scene;
  scene.skin.counts_per_newton = 320;
  scene.skin.threshold_counts = 4 * std::sqrt(noise_counts * noise_counts + 1.0 / 12);
  scene.sensor.noise_counts = noise_counts;
  scene.sensor.dead_zone_counts = 5;
  scene.sensor.gain_spread = 0.1;
  scene.sensor.tare_counts = 12;
  scene.sensor.tare_spread_counts = 2;
  scene.sensor.adc_bits = 12;
  scene.uncertainty = true;
  scene.seed = seed;
  return scene;
}

Scene all_directions(double noise_counts, const std::vector<double>& magnitudes_n) {
  Scene scene = real_sensor(noise_counts, 31);
  DirectionSweep sweep;
  sweep.directions = 120;
  sweep.inclinations = 61;
  sweep.magnitudes_n = magnitudes_n;
  scene.skin.rows = 2 * sweep.inclinations * static_cast<std::uint32_t>(magnitudes_n.size());
  scene.skin.cols = 2 * sweep.directions;
  scene.load = sweep;
  scene.frames = 12;
  return scene;
}

ClosedFormContact sphere(ContactMotion motion, ContactKey first, ContactKey last) {
  ClosedFormContact contact;
  contact.motion = motion;
  contact.contact_radius_mm = 12;
  contact.reference_load_n = 120;
  contact.friction = 0.9;
  contact.direction_deg = 30;
  contact.tangential_ratio = 0.7;
  contact.path = {first, last};
  return contact;
}

Scene indenters(double noise_counts) {
  Scene scene = real_sensor(noise_counts, 32);
  scene.skin.rows = 128;
  scene.skin.cols = 128;
  scene.frames = 40;
  scene.load = std::vector{
      sphere(ContactMotion::press, {0, -20, 20, 20}, {0.4, -20, 20, 120}),
      sphere(ContactMotion::slide, {0, 10, 20, 80}, {0.4, 26, 24, 80}),
      sphere(ContactMotion::partial_slip, {0, -22, -20, 60}, {0.4, -20, -20, 100}),
      sphere(ContactMotion::spin, {0, 20, -20, 100}, {0.4, 22, -22, 100}),
  };
  return scene;
}

SolverPlan plan_for(const Simulator& simulator) {
  const Scene& scene = simulator.scene();
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, scene);
  plan.estimator = Estimator::direct;
  return plan;
}

/// The usable bits that a pillar would have without noise.
std::uint8_t bits_without_noise(const ForceField& truth, std::size_t pillar,
                                const SolverPlan& plan) {
  const auto v =
      bound::model_readings({truth.shear_x[pillar], truth.shear_y[pillar], truth.normal[pillar]},
                            plan.skin.counts_per_newton);
  return bound::bits_above(v, plan.calibration.dead_zone.front() + plan.skin.threshold_counts);
}

/// Effect of noise on the usable bits of a pillar.
enum class Luck : std::uint8_t { none, good, bad };

Luck luck_of(std::uint8_t solved, std::uint8_t without_noise) {
  if ((solved & ~without_noise) != 0) return Luck::good;
  return solved == without_noise ? Luck::none : Luck::bad;
}

/// `solved` without a claim for pillars of other luck: Coverage passes over what is inconsistent.
ForceField only(Luck luck, ForceField solved, const ForceField& truth, const SolverPlan& plan) {
  for (std::size_t i = 0; i < solved.elements(); ++i) {
    const auto usable = static_cast<std::uint8_t>(solved.status[i] & status::kUsable);
    if (luck_of(usable, bits_without_noise(truth, i, plan)) == luck) continue;
    solved.status[i] |= status::kInconsistent;
  }
  return solved;
}

}  // namespace

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      {"forces of 60 to 1000 counts, noise 1", all_directions(1, {0.1875, 0.5, 1.2, 3.1})},
      {"forces of 60 to 1000 counts, noise 0.3", all_directions(0.3, {0.1875, 0.5, 1.2, 3.1})},
      {"small forces, 15 to 40 counts, noise 1", all_directions(1, {0.047, 0.0625, 0.09, 0.125})},
      {"four indenters on the skin, noise 0.5", indenters(0.5)},
  };
  return all;
}

Parted cover(const Scene& scene) {
  const Simulator simulator(scene);
  const SolverPlan plan = plan_for(simulator);
  FrameBuffer raw(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  Parted parted;
  for (std::uint64_t index = 0; index < scene.frames; ++index) {
    simulator.render(index, raw, truth);
    const ForceField solved = solve_on_host(plan, raw.view());
    parted.all.add(solved.view(), truth.view());
    const auto add = [&](Luck luck, Coverage& coverage) {
      coverage.add(only(luck, solved, truth, plan).view(), truth.view());
    };
    add(Luck::none, parted.rightly_read);
    add(Luck::good, parted.by_luck);
    add(Luck::bad, parted.by_bad_luck);
  }
  return parted;
}

}  // namespace pillarfield::coverage_study
