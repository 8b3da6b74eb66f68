// A live loop: takes the tare of the unloaded skin, then solves each frame as it arrives and prints
// the total force. Replace Sensor by your own driver.
#include <pillarfield/pillarfield.h>

#include <cstdio>
#include <random>

namespace pf = pillarfield;

namespace {

constexpr std::uint32_t kRows = 40;
constexpr std::uint32_t kCols = 60;
constexpr double kCountsPerNewton = 320;

/// A stand-in for a sensor: 12 bits, an offset of 100 counts, noise of 1 count.
class Sensor {
 public:
  /// Reads a frame while `pillars` pillars are pressed with 0.5 N each.
  void read(std::span<std::uint16_t> readings, std::uint32_t pillars) {
    for (std::uint32_t row = 0; row < kRows; ++row) {
      for (std::uint32_t col = 0; col < kCols; ++col) {
        const bool pressed = row / 2 == 10 && col / 2 < pillars;
        const double reading = 100 + noise_(random_) + (pressed ? 0.5 * kCountsPerNewton : 0);
        readings[row * kCols + col] = static_cast<std::uint16_t>(reading + 0.5);
      }
    }
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, 1};
};

}  // namespace

int main() try {
  Sensor sensor;
  pf::SolverPlan plan;
  plan.skin.rows = kRows;
  plan.skin.cols = kCols;
  plan.skin.counts_per_newton = kCountsPerNewton;
  plan.skin.full_scale_counts = 4095;
  plan.sensel_type = pf::SenselType::u16;
  pf::FrameBuffer frame(plan.sensel_type, kRows, kCols);
  const std::span readings = frame.readings<std::uint16_t>();

  // Tare: mean and noise of each sensel, a threshold, and a mask of faulty sensels.
  pf::TareFrames unloaded("unloaded frames", plan.skin, plan.sensel_type);
  for (int i = 0; i < 100; ++i) {
    sensor.read(readings, 0);
    unloaded.add(frame.view());
  }
  const pf::TareResult tare = pf::take_tare(pf::blank_calibration(plan.skin), unloaded, {});
  pf::apply(tare.calibration, plan.skin, plan.calibration);
  plan.frame_interval_s = 0.001;
  pf::set_baseline(plan, 10);  // untouched sensels: follow drift within 10 s
  std::printf("tare %.1f counts, noise %.2f counts, %zu sensels masked\n", tare.tare_counts,
              tare.noise_counts, tare.findings.size());

  pf::Processor processor(pf::open_device(), plan);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    sensor.read(readings, i / 200);
    processor.submit(frame.view());
    const pf::ForceFieldView forces = processor.receive();
    double normal_n = 0;
    for (const float n : forces.normal) normal_n += n;
    if (i % 200 == 100) std::printf("frame %u: %.2f N\n", i, normal_n);
  }
} catch (const pf::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
