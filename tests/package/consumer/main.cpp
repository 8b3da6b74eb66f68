// One pillar, pressed straight down: what somebody else's program needs to solve a frame.

#include <algorithm>
#include <cstdio>

#include "pillarfield/error.h"
#include "pillarfield/processor.h"
#include "pillarfield/version.h"

int main() {
  try {
    pillarfield::SolverPlan plan;
    plan.skin.rows = 2;
    plan.skin.cols = 2;
    plan.skin.counts_per_newton = 320;
    plan.sensel_type = pillarfield::SenselType::u8;

    pillarfield::FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
    std::ranges::fill(frame.readings<std::uint8_t>(), std::uint8_t{80});

    pillarfield::Processor processor(pillarfield::open_device(), plan);
    processor.submit(frame.view());
    const pillarfield::ForceFieldView forces = processor.receive();
    std::printf("Pillarfield %s: normal force %g N\n", pillarfield::kVersion,
                static_cast<double>(forces.normal[0]));
    return 0;
  } catch (const pillarfield::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
