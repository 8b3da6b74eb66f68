// Solves a frame in memory in which one pillar is pressed and sheared to the right.
#include <pillarfield/pillarfield.h>

#include <cstdio>
#include <vector>

int main() try {
  pillarfield::SolverPlan plan;
  plan.skin.rows = 16;  // sensels; four of them make a pillar
  plan.skin.cols = 24;
  plan.skin.counts_per_newton = 320;
  plan.skin.threshold_counts = 3;
  plan.sensel_type = pillarfield::SenselType::u16;

  std::vector<std::uint16_t> readings(plan.skin.sensels());  // row by row from the top left
  for (const int row : {6, 7}) {
    readings[row * plan.skin.cols + 8] = 115;
    readings[row * plan.skin.cols + 9] = 205;
  }

  pillarfield::Processor processor(pillarfield::open_device(), plan);
  processor.submit(
      {readings.data(), plan.sensel_type, plan.skin.rows, plan.skin.cols, plan.skin.cols});
  const pillarfield::ForceFieldView forces = processor.receive();

  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    if (pillarfield::region_of(forces.status[i]) == pillarfield::Region::none) continue;
    std::printf("row %zu, column %zu: shear (%.3f, %.3f) N, normal %.3f N\n", i / forces.cols,
                i % forces.cols, forces.shear_x[i], forces.shear_y[i], forces.normal[i]);
  }
} catch (const pillarfield::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
