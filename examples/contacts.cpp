// Reads a recording, solves every frame, tracks its contacts, and prints them as a table.
#include <pillarfield/pillarfield.h>

#include <cstdio>

namespace pf = pillarfield;

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "Usage: contacts RECORDING\n");
    return 2;
  }
  const auto recording = pf::open_frames(argv[1]);

  pf::SolverPlan plan;
  plan.skin = recording->skin();
  plan.sensel_type = recording->sensel_type();
  plan.calibration = recording->calibration();
  pf::Processor processor(pf::open_device(), plan);

  pf::ContactOptions options;
  options.minimum_pillars = 4;
  pf::set_sensor(options, plan);
  pf::ContactTracker tracker(plan.skin.pillar_pitch_mm(), options);

  std::printf("time_s,id,x_mm,y_mm,shear_x_n,shear_y_n,normal_n,torque_nmm,friction,slip\n");
  pf::FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  for (std::uint64_t i = 0; i < recording->frames(); ++i) {
    const double time_s = recording->read(i, frame);
    processor.submit(frame.view());
    const pf::ForceFieldView forces = processor.receive();
    for (const auto& contact : tracker.update(forces, time_s, processor.contacts()).contacts) {
      const pf::ContactQuantities& q = contact.quantities;
      std::printf("%.3f,%llu,%.2f,%.2f,%.4f,%.4f,%.4f,%.3f,", time_s,
                  static_cast<unsigned long long>(contact.track_id), q.centre_of_pressure.x_mm,
                  q.centre_of_pressure.y_mm, q.shear_x_n, q.shear_y_n, q.normal_n, q.torque_nmm);
      if (q.friction) std::printf("%.2f", *q.friction);
      std::printf(",%s\n", pf::name_of(q.slip));
    }
  }
} catch (const pf::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
