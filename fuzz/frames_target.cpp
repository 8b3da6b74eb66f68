#include <cmath>
#include <string>

#include "fuzz/some_frames.h"
#include "fuzz/targets.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/recording.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::fuzz {
namespace {

SolverPlan plan_of_source(const FrameSource& source) {
  SolverPlan plan;
  plan.skin = source.skin();
  plan.sensel_type = source.sensel_type();
  plan.calibration = source.calibration();
  return plan;
}

}  // namespace

void read_plain(const std::filesystem::path& path, const ReadOptions& options) {
  ReadOptions untimed = options;
  untimed.untimed = true;
  ReadOptions lines = untimed;
  lines.frame_size = FrameSize{4, 6};
  ReadOptions named = untimed;
  named.dataset = "raw";
  std::string failure;
  for (const ReadOptions& each : {untimed, lines, named}) {
    try {
      read_frames(path, each);
      return;
    } catch (const Error& error) {
      if (failure.empty()) failure = error.what();
    }
  }
  throw Error({}, failure);
}

void read_frames(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  const auto source = open_frames(path, options);
  const Skin& skin = source->skin();
  if (skin.sensels() > kMaxRead) return;
  const SolverPlan plan = plan_of_source(*source);
  check(plan, path.native());
  FrameBuffer frame(plan.sensel_type, skin.rows, skin.cols);
  ForceField truth(skin);
  ContactTracker tracker(skin.element_pitch_mm(), {.layout = skin.layout, .threads = 1});
  for (const std::uint64_t index : some_frames(source->frames())) {
    const double time_s = source->read(index, frame);
    if (source->has_truth()) source->read_truth(index, truth);
    if (skin.sensels() > kMaxSolved) continue;
    const double when_s = std::isfinite(time_s) ? time_s : static_cast<double>(index);
    tracker.update(solve_on_host(plan, frame.view()).view(), when_s);
  }
}

}  // namespace pillarfield::fuzz
