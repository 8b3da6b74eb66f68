// Simulates a scene, writes a recording with its truth, and prints the error of the solved forces.
// Uses no OpenCL.
#include <pillarfield/pillarfield.h>

#include <cstdio>

namespace pf = pillarfield;

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "Usage: simulate SCENE.toml RECORDING.h5\n");
    return 2;
  }
  const pf::Simulator simulator(pf::load_scene(argv[1]));
  const pf::Scene& scene = simulator.scene();

  pf::SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  pf::set_solver(plan, scene);

  pf::RecordingWriter writer(argv[2], plan.skin, plan.sensel_type, plan.calibration,
                             {.truth = true});
  pf::FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  pf::ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  pf::Comparison comparison;
  for (std::uint64_t i = 0; i < scene.frames; ++i) {
    simulator.render(i, frame, truth);
    writer.append(frame.view(), simulator.time_of(i), &truth);
    comparison.add(pf::solve_on_host(plan, frame.view()).view(), truth.view());
  }
  writer.finish();

  for (const pf::Region region : {pf::Region::one, pf::Region::two, pf::Region::three}) {
    const pf::RegionErrors errors = comparison.region(region);
    std::printf("region %s: %llu pillars, RMS error %.4f N\n", pf::name_of(region),
                static_cast<unsigned long long>(errors.pillars), errors.rms_n);
  }
} catch (const pf::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
