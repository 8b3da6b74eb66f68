// pillarfield simulate: a recording with exact truth from a scene.

#include <fmt/format.h>

#include <optional>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/number_range.h"
#include "cli/output_options.h"
#include "cli/progress.h"
#include "cli/stopwatch.h"
#include "pillarfield/printable.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::cli {
namespace {

struct SimulateOptions {
  std::string scene;
  std::string output;
  std::optional<std::uint32_t> frames;
  std::optional<std::uint64_t> seed;
  bool uncalibrated = false;
  Replace replace = Replace::results;
  bool json = false;
  bool quiet = false;
};

Scene scene_of(const SimulateOptions& options) {
  Scene scene = load_scene(options.scene);
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
  const double millimetres = skin.sensel_pitch_mm;
  fmt::print(
      "Simulated '{}': {} frames at {} Hz of {} x {} sensels ({:.0f} x {:.0f} mm, {} pillars) "
      "in {:.2f} s\nWrote {} with the true force of every pillar\n",
      printable(scene.title), scene.frames, scene.rate_hz, skin.rows, skin.cols,
      skin.cols * millimetres, skin.rows * millimetres, skin.pillars(), seconds,
      printable(options.output));
}

void simulate(const SimulateOptions& options) {
  const Stopwatch watch;
  check_outputs({options.scene}, {{options.output, OutputKind::recording}}, options.replace);
  const Simulator simulator(scene_of(options));
  const Scene& scene = simulator.scene();
  FrameBuffer frame(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  Skin skin = scene.skin;
  if (options.uncalibrated) skin.power_law.reset();
  RecordingWriter writer(options.output, skin, simulator.sensel_type(),
                         options.uncalibrated ? Calibration() : simulator.calibration(),
                         {.truth = true, .replace = options.replace});
  {
    Progress progress("Simulating", scene.frames, options.quiet);
    for (std::uint64_t index = 0; index < scene.frames; ++index) {
      stop_if_interrupted(index, options.output);
      simulator.render(index, frame, truth);
      writer.append(frame.view(), simulator.time_of(index), &truth);
      progress.show(index + 1);
    }
  }
  writer.finish();
  print_summary(options, scene, watch.seconds());
}

}  // namespace

void add_simulate(CLI::App& app, Work& work) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* const command = app.add_subcommand(
      "simulate", "Make a recording of a scene: frames as the sensor gives them, and the truth");
  command->add_option("SCENE", options->scene, "Scene file (TOML), see docs/scenes.md")->required();
  command->add_option("-o,--output", options->output, "Recording to write (HDF5)")->required();
  command->add_option("--frames", options->frames, "Number of frames [the scene's]")
      ->check(whole_number_range(1, 100'000'000));
  command->add_option("--seed", options->seed, "Seed of the sensor's randomness [the scene's]")
      ->check(whole_number_range(0, kLargestSeed));
  command->add_flag("--uncalibrated", options->uncalibrated,
                    "Leave out the sensor's calibration, as of a skin that is new");
  add_overwrite_option(*command, options->replace);
  command->add_flag("--json", options->json, "Print the summary as JSON");
  command->add_flag("-q,--quiet", options->quiet, "Show no progress");
  command->callback([options, &work] { work = [options] { simulate(*options); }; });
}

}  // namespace pillarfield::cli
