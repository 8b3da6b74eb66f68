// pillarfield simulate: a recording with exact truth from a scene.

#include <fmt/format.h>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/stopwatch.h"
#include "cli/warnings.h"
#include "pillarfield/printable.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::cli {
namespace {

Scene scene_of(const SimulateOptions& options) {
  Scene scene = load_scene_with_warnings(options.scene);
  if (options.frames) scene.frames = *options.frames;
  if (options.seed) scene.seed = *options.seed;
  return scene;
}

void print_summary(const SimulateOptions& options, const Scene& scene, double seconds) {
  const Skin& skin = scene.skin;
  if (options.json) {
    const nlohmann::ordered_json summary = {{"output", options.output}, {"frames", scene.frames},
                                            {"rate_hz", scene.rate_hz}, {"sensel_rows", skin.rows},
                                            {"sensel_cols", skin.cols}, {"seed", scene.seed},
                                            {"seconds", seconds}};
    fmt::print("{}\n", json_text(summary));
    return;
  }
  if (options.quiet) return;
  const double millimetres = skin.sensel_pitch_mm.col_mm;
  fmt::print(
      "Simulated '{}': {} at {} Hz of {} x {} sensels ({:.0f} x {:.0f} mm, {}) "
      "in {:.2f} s\nWrote {} with the true force of every {}\n",
      printable(scene.title), counted(scene.frames, "frame"), rounded(scene.rate_hz), skin.rows,
      skin.cols, skin.cols * millimetres, skin.rows * millimetres,
      skin.has_pillars() ? grouped(skin.pillars()) + " pillars" : "no pillars", seconds,
      printable(options.output), skin.has_pillars() ? "pillar" : "sensel");
}

/// Files that a scene names.
std::vector<std::filesystem::path> files_of(const Scene& scene) {
  std::vector<std::filesystem::path> files;
  for (const Indenter& indenter : scene.indenters) files.push_back(indenter.height_map);
  if (scene.surface_map) files.push_back(scene.surface_map->path);
  return files;
}

}  // namespace

void simulate(const SimulateOptions& options) {
  const Stopwatch watch;
  check_outputs({options.scene}, {{options.output, OutputKind::recording}}, options.replace);
  const Simulator simulator(scene_of(options));
  const Scene& scene = simulator.scene();
  check_outputs(files_of(scene), {{options.output, OutputKind::recording}}, options.replace);
  Skin skin = scene.skin;
  if (options.uncalibrated) skin.power_law.reset();
  RecordingWriter writer(options.output, skin, simulator.sensel_type(),
                         options.uncalibrated ? Calibration() : simulator.calibration(),
                         {.truth = true, .replace = options.replace});
  {
    Progress progress("Simulating", scene.frames, options.quiet);
    simulator.render_all(0, scene.frames,
                         [&](std::uint64_t index, const FrameView& frame, const ForceField& truth) {
                           stop_if_interrupted(index, options.output);
                           writer.append(frame, simulator.time_of(index), &truth);
                           progress.show(index + 1);
                         });
  }
  writer.finish();
  print_summary(options, scene, watch.seconds());
}

}  // namespace pillarfield::cli
