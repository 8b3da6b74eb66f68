// The command line: every command's options in groups, their help and its examples.

#include "cli/options/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "base/nearest_word.h"
#include "cli/commands.h"
#include "cli/options/argument_group.h"
#include "cli/options/completion.h"
#include "cli/options/help.h"
#include "cli/options/shared_arguments.h"
#include "cli/parts/share.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

/// Scenes store seeds as integers of TOML.
constexpr std::uint64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();

void add_sensor(CLI::App* command, PlanOptions& plan) {
  Group input(command, "Input");
  input.text("--scene", plan.scene, "FILE",
             "Scene to take the sensor's constants and the solver's settings from");
  input.text("--calibration", plan.calibration, "FILE",
             "Calibration to take planes and constants from");
  add_trust(command, plan.read);
  Group sensor(command, "Sensor");
  sensor.number("--threshold", plan.threshold_counts, "COUNTS",
                "Readings above this are usable [the file's]");
  sensor.number("--counts-per-newton", plan.counts_per_newton, "COUNTS",
                "Counts per newton and pillar [the file's]");
  sensor.number("--full-scale", plan.full_scale_counts, "COUNTS",
                "Readings of this or more are saturated [the file's]");
  sensor.number("--noise", plan.noise_counts, "COUNTS",
                "Standard deviation of a reading [the calibration's or scene's]");
  sensor.number("--follow-baseline", plan.baseline_time_s, "SECONDS",
                "Time constant with which the tare of untouched sensels follows drift [constant "
                "tare]",
                1e-6, 1e9);
  sensor.whole("--baseline-interval", plan.baseline_interval, "N",
               "Follow it in one of N pillar rows per frame, at 1/N of the cost [1; with "
               "--everything up to 64]",
               1, 1024);
}

void add_solver(CLI::App* command, PlanOptions& plan) {
  Group solver(command, "Solver");
  solver.choice<Estimator>(
      "--estimator", plan.estimator,
      {{"direct", Estimator::direct}, {"paper", Estimator::paper}, {"contact", Estimator::contact}},
      "direct: each pillar from its own readings; paper: the paper's equations; contact: "
      "ambiguous pillars from the friction of their contact [direct]",
      "field", "contact");
  solver
      .text("--outputs", plan.outputs, "WORDS",
            "Planes to compute, separated by commas: forces; angles adds magnitude, theta and "
            "phi; uncertainty adds standard deviations and intervals [forces]")
      ->check(one_of({"forces", "angles", "uncertainty"}))
      ->delimiter(',');
  solver.number("--segment-point", plan.segment_point, "RATIO",
                "Reported point of a region 3 pillar on its feasible segment, as a fraction of the "
                "largest normal force; 0.5 minimises the largest error [0.875]",
                1e-6, 1);
  solver.number("--parity-tolerance", plan.parity_tolerance_counts, "COUNTS",
                "Flag pillars whose parity residual is larger [not tested]");
  solver.flag("--everything", plan.everything,
              "All outputs, the parity test and --follow-baseline; needs the noise");
  Group friction(command, "Friction");
  friction.number("--friction", plan.friction, "RATIO",
                  "Friction coefficient of all contacts, known to 3 % [estimated]", 0.1, 9.9);
  friction.number("--friction-bound", plan.friction_bound, "RATIO",
                  "Upper bound of friction coefficients [none]", 0.1, 100);
  friction
      .number("--friction-prior", plan.friction_prior, "MEDIAN,SPREAD",
              "Log-normal prior of friction coefficients [1,0.5]", 0.01, 9.9)
      ->expected(2)
      ->delimiter(',');
  friction.flag("--unrelated-frames", plan.unrelated_frames,
                "Carry no friction over from earlier frames");
}

void add_device(CLI::App* command, DeviceOptions& options) {
  Group device(command, "Device");
  device.text("--device", options.name, "DEVICE",
              "OpenCL device, by index or part of its name [the best]; see info --devices");
  device.choice<Memory>(
      "--memory", options.memory,
      {{"auto", Memory::automatic}, {"shared", Memory::shared}, {"staged", Memory::staged}},
      "shared: zero copy; staged: copied to the device [auto]");
}

void add_simulate(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<SimulateOptions>(
      parent, work, simulate, "simulate",
      "Make a recording from a scene: frames of the sensor and the true forces.",
      "  pillarfield simulate scenes/demo.toml -o demo.h5\n"
      "  pillarfield simulate scenes/sliding.toml -o noisy.h5 --frames 20 --seed 7\n");
  Group input(command, "Input");
  input.file("SCENE", options->scene, "Scene (TOML), see docs/scenes.md");
  input.whole("--frames", options->frames, "N", "Number of frames [the scene's]", 1, 100'000'000);
  input.whole("--seed", options->seed, "N", "Seed of the sensor's noise [the scene's]", 0,
              kLargestSeed);
  add_output(command, *options, "Recording (HDF5)");
  Group(command, "Output")
      .flag("--uncalibrated", options->uncalibrated,
            "Leave out the sensor's calibration, as for a new skin");
  add_general(command, *options, "Print the summary as JSON", kQuietWriter);
}

/// Accepts K/N, or with `all` N and auto.
CLI::Validator parts(bool all) {
  const auto error_of = [=](const std::string& text) -> std::string {
    if (!all) {
      return is_part(text) ? ""
                           : fmt::format("'{}' is not a part K/N, such as 7/64; N is at most {}",
                                         text, kMostParts);
    }
    return text == "auto" ? "" : whole_number_in(1, kMostParts)(text);
  };
  return {error_of, ""};
}

void add_parts(CLI::App* command, PartOptions& options) {
  Group group(command, "Parts");
  CLI::Option* const part =
      group
          .text("--part", options.part, "K/N",
                "Solve only the K-th of N ranges of frames, into the folder OUTPUT.parts; join "
                "puts the parts together")
          ->check(parts(false));
  group
      .text("--parts", options.parts, "N|auto",
            "Solve this process's share of N parts, by its rank under mpirun, srun or in an array "
            "job; all of them without; auto: one part per process")
      ->check(parts(true))
      ->excludes(part);
  CLI::Option* const every = group.whole(
      "--checkpoint-every", options.checkpoint_every, "FRAMES",
      "Begin anew at multiples of this frame what is carried from frame to frame, so that parts "
      "may begin there [never]",
      1, 1'000'000'000);
  group
      .whole("--warm-up", options.warm_up, "FRAMES",
             "Frames before each checkpoint that are solved first [a tenth of "
             "--checkpoint-every]",
             0, 1'000'000'000)
      ->needs(every);
}

void add_solve(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<SolveOptions>(
      parent, work, solve, "solve",
      "Turn frames into fields of three-axis force, in newtons per pillar.",
      "  pillarfield simulate scenes/demo.toml -o demo.h5\n"
      "  pillarfield solve demo.h5 -o forces.h5\n"
      "  pillarfield solve demo.h5 -o forces.npy --outputs angles,uncertainty --noise 0.5\n"
      "  pillarfield solve demo.h5 -o forces.h5 --estimator contact --contacts contacts.csv\n");
  Group input(command, "Input");
  input.file(
      "INPUT", options->input,
      "Recording (HDF5), Tekscan ASCII export, or plain data: .npy, .npz, CSV, HDF5 dataset");
  add_tare_frames(command, options->plan.read);
  add_plain_data(command, options->plan.read, true);
  add_output(command, *options,
             "Force fields; the ending sets the format: " + endings_of(OutputKind::forces));
  add_sensor(command, options->plan);
  add_solver(command, options->plan);
  Group contacts(command, "Contacts");
  CLI::Option* const file =
      contacts.text("--contacts", options->contacts_file, "FILE",
                    "Track contacts and write them: " + endings_of(OutputKind::contacts) +
                        "; the .h5 of --output holds them too");
  ContactOptions& found = options->contacts;
  contacts
      .whole("--minimum-pillars", found.minimum_pillars, "N",
             "Leave out contacts of fewer pillars [1]", 0,
             std::numeric_limits<std::uint32_t>::max())
      ->needs(file);
  contacts
      .number("--contact-reach", found.reach_mm, "MM",
              "Largest movement of a contact between frames [10]")
      ->needs(file);
  add_parts(command, options->parts);
  add_device(command, options->device);
  add_general(command, *options, "Print the summary as JSON", kQuietWriter);
}

void add_join(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<JoinCommand>(
      parent, work, join, "join", "Join the parts of solve --part into one file of forces.",
      "  pillarfield simulate scenes/sliding.toml -o sliding.h5\n"
      "  pillarfield solve sliding.h5 -o forces.h5 --part 1/2\n"
      "  pillarfield solve sliding.h5 -o forces.h5 --part 2/2\n"
      "  pillarfield join forces.h5\n");
  Group input(command, "Input");
  input.file("OUTPUT", options->output,
             "Output of solve (.h5), whose parts lie in the folder OUTPUT.parts");
  input.flag("--allow-missing", options->allow_missing,
             "Join although parts are missing; their frames read as NaN");
  add_trust(command, options->read);
  Group(command, "Output")
      .flag("--copy", options->copy,
            "Copy all values, so that the parts may be removed [refer to them]");
  add_overwrite(command, options->replace);
  add_general(command, *options, "Print the summary as JSON", kQuietWriter);
}

void add_pace(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<PaceOptions>(
      parent, work, pace, "pace",
      "Solve frames at a fixed rate and report the latency of their forces.",
      "  pillarfield pace scenes/demo.toml --seconds 2\n"
      "  pillarfield pace scenes/demo.toml --rate 500 --everything --seconds 2\n");
  command->alias("live");
  Group input(command, "Input");
  input.file("SOURCE", options->source,
             "Scene (TOML), or frames as of solve, replayed from memory");
  add_tare_frames(command, options->plan.read);
  add_plain_data(command, options->plan.read, false);
  input.whole("--memory-limit", options->memory_limit_mib, "MIB",
              "Memory limit of the frames loaded beforehand [1024]", 1, 1U << 20U);
  Group pacing(command, "Pace");
  pacing.number("--rate", options->rate_hz, "HZ", "Frames per second [1000]", 0.01, 1e5);
  pacing.number("--seconds", options->seconds, "SECONDS", "Duration of the run [10]");
  pacing.number("--deadline", options->deadline_ms, "MS",
                "Latency above which a frame counts as missed [one period]", 1e-3, 1e6);
  pacing.whole("--backlog", options->backlog_frames, "FRAMES",
               "Drop a frame that is late by more periods [4]", 0, 1000);
  pacing.flag("--strict", options->strict,
              "Fail if a frame was dropped or missed its deadline, or the run was interrupted");
  add_sensor(command, options->plan);
  add_solver(command, options->plan);
  add_device(command, options->device);
  Group device(command, "Device");
  device.whole("--in-flight", options->frames_in_flight, "FRAMES",
               "Number of frames in the solver at once [2]", 1, 64);
  device.number("--spin", options->spin_us, "US", "Busy-wait for this last part of each wait [0]",
                0, 1e6);
  device.flag("--realtime", options->realtime,
              "Request real-time scheduling and locked memory; warn if refused");
  add_general(command, *options, "Print the report as JSON", kQuietReport);
}

void add_contacts(CLI::App* command, ContactOptions& options) {
  Group contacts(command, "Contacts");
  contacts.whole("--minimum-pillars", options.minimum_pillars, "N",
                 "Leave out contacts of fewer pillars [1]", 0,
                 std::numeric_limits<std::uint32_t>::max());
  contacts.number("--contact-reach", options.reach_mm, "MM",
                  "Largest movement of a contact between frames [10]");
}

void add_stream_ends(CLI::App* command, StreamOptions& options) {
  Group output(command, "Output");
  output
      .text("--to", options.sinks, "SINK",
            "Send forces on, any number of times: shm:NAME, udp:ADDRESS:PORT, foxglove[:PORT], "
            "FILE.mcap, or a file as solve writes it")
      ->allow_extra_args(false);
  output.text("--record", options.record, "FILE", "Record the raw frames (HDF5)");
  add_overwrite(command, options.replace);
  Group run(command, "Run");
  run.number("--seconds", options.seconds, "SECONDS", "End after this time [at the source's end]",
             1e-3, 1e9);
  run.whole("--frames", options.frames, "N", "End after this many frames", 1,
            std::numeric_limits<std::int64_t>::max());
  run.number("--end-when-idle", options.most_idle_s, "SECONDS",
             "End when no frame came for this time [wait for the sensor]", 0.01, 1e9);
  run.number("--tare", options.tare_s, "SECONDS",
             "Measure the tare of the untouched skin over this time at the start [0]", 0, 60);
  command
      ->add_option("--control", options.control,
                   "Take lines of control from a socket that the program makes, or from standard "
                   "input (-): tare, pause, resume, record FILE, record stop, health, quit")
      ->type_name("SOCKET|-")
      ->group("Run");
  run.number("--health-interval", options.health_interval_s, "SECONDS",
             "Time between reports of health [1]", 0.05, 3600);
}

void add_stream(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<StreamOptions>(
      parent, work, stream, "stream",
      "Solve live frames of a sensor and send their forces on (docs/streams.md).",
      "  pillarfield stream scenes/demo.toml --frames 50 --record live.h5\n"
      "  pillarfield stream scenes/demo.toml --repeat --seconds 1 --to udp:127.0.0.1:9870\n");
  Group input(command, "Input");
  command
      ->add_option("SOURCE", options->source,
                   "- (packets on standard input), shm:NAME, udp:ADDRESS:PORT, serial:DEVICE, or a "
                   "scene or file of frames, replayed at its own pace")
      ->required()
      ->type_name("SOURCE")
      ->group("Input");
  input.number("--rate", options->rate_hz, "HZ",
               "Frames per second of a replayed file [its own], or of the sensor", 0.01, 1e5);
  input.flag("--repeat", options->repeat, "Replay a file again and again");
  input.whole("--baud", options->serial_baud, "BAUD", "Bits per second of serial: [2000000]", 300,
              100'000'000);
  add_plain_data(command, options->plan.read, false);
  add_stream_ends(command, *options);
  add_sensor(command, options->plan);
  add_solver(command, options->plan);
  add_contacts(command, options->contacts);
  add_device(command, options->device);
  Group(command, "Device")
      .whole("--in-flight", options->frames_in_flight, "FRAMES",
             "Number of frames in the solver at once [2]", 1, 64);
  add_general(command, *options, "Print reports of health and the summary as lines of JSON",
              kQuietWriter);
}

void add_body_input(CLI::App* command, BodyOptions& options) {
  Group(command, "Input")
      .file("BODY", options.file, "Patches, poses and scenes (TOML), see docs/whole_body.md");
  Group(command, "Device")
      .text("--device", options.device.name, "DEVICE",
            "OpenCL device, by index or part of its name [the best]; see info --devices");
}

void add_body(CLI::App& parent, Work& work) {
  CLI::App* const steps = parent.add_subcommand(
      "body", "Plan and simulate the skin of a whole body; see docs/whole_body.md.");
  steps->footer("  pillarfield body simulate scenes/body/hand.toml --loss 2\n");
  steps->require_subcommand(1);
  const auto [plan, plan_options] = add_command<BodyOptions>(
      *steps, work, plan_body, "plan",
      "Sizes and rates of a body, and the time a frame takes on this machine.",
      "  pillarfield body plan scenes/body/hand.toml\n");
  add_body_input(plan, *plan_options);
  add_general(plan, *plan_options, "Print the plan as JSON", kQuietReport);
  const auto [run, options] = add_command<BodyOptions>(
      *steps, work, simulate_body, "simulate",
      "Simulate the sensors of a body, lose some of their packets, and solve the others.",
      "  pillarfield body simulate scenes/body/hand.toml --loss 5 --seconds 1\n");
  add_body_input(run, *options);
  Group group(run, "Run");
  group.number("--loss", options->loss_percent, "PERCENT", "Packets lost at random [0]", 0, 99);
  group.number("--rate", options->rate_hz, "HZ", "Frames per second [the body's]", 1, 1e5);
  group.number("--refresh", options->refresh_s, "SECONDS",
               "Time in which every block is sent at least once [the body's]", 1e-3, 3600);
  group.number("--seconds", options->seconds, "SECONDS", "Duration [2]", 1e-3, 1e5);
  group.whole("--scene-frames", options->scene_frames, "N",
              "Most frames of a scene that are rendered and repeated [16]", 1, 10'000);
  group.whole("--seed", options->seed, "N", "Seed of losses and delays [1]", 0, kLargestSeed);
  add_general(run, *options, "Print the summary as JSON", kQuietReport);
  add_help(steps);
}

void add_compare(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<CompareOptions>(
      parent, work, compare, "compare", "Compare solved forces with the truth by region.",
      "  pillarfield simulate scenes/sliding.toml -o sliding.h5\n"
      "  pillarfield solve sliding.h5 -o sliding_forces.h5\n"
      "  pillarfield compare sliding_forces.h5 sliding.h5\n"
      "  pillarfield compare sliding_forces.h5 sliding.h5 --json\n");
  Group input(command, "Input");
  input.file("FORCES", options->forces, "Force fields of solve (.h5)");
  input.file("RECORDING", options->recording, "Recording that they were solved from, with truth");
  input.flag("--allow-missing", options->allow_missing,
             "Leave out the frames of missing parts of a joined file");
  add_trust(command, options->read);
  add_general(command, *options, "Print the table as JSON", kQuietReport);
}

void add_testbed(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<TestbedOptions>(
      parent, work, run_testbed, "testbed",
      "Repeat the paper's experiment on one pillar: Table II and figures.",
      "  pillarfield testbed --runs 100\n"
      "  pillarfield testbed --runs 100 --dead-zone 0 --json\n");
  testbed::Parameters& parameters = options->parameters;
  PillarSensor& sensor = parameters.sensor;
  Group setup(command, "Sensor");
  setup.number("--counts-per-newton", sensor.counts_per_newton, "COUNTS",
               "Counts per newton and pillar [20]");
  setup.number("--dead-zone", sensor.dead_zone_counts, "COUNTS",
               "Counts that a sensel loses before it responds [144]");
  setup.number("--threshold", sensor.threshold_counts, "COUNTS",
               "Readings above this are usable [3]");
  setup.number("--noise", sensor.noise_counts, "COUNTS", "Standard deviation of a reading [0.5]");
  setup.number("--full-scale", sensor.full_scale_counts, "COUNTS",
               "Largest reading of the converter [4095]");
  Group probe(command, "Probe");
  probe.number("--positioner", parameters.positioner_rad, "RAD",
               "Largest error of an angle [0.04]");
  probe.number("--play", parameters.play_rad, "RAD",
               "Largest rotation of the direction as the force rises [0.01]");
  probe.number("--probe-resolution", parameters.probe_resolution_n, "NEWTONS",
               "Resolution of the applied force [0.1]");
  probe.whole("--runs", options->runs, "N", "Repetitions of the experiment [1000]", 2, 1'000'000);
  probe.whole("--seed", parameters.seed, "N", "Seed of all randomness [1]", 0, kLargestSeed);
  Group(command, "Output")
      .text("--figures", options->figures, "FOLDER",
            "Folder for Figures 3, 4, 5 and 8 as SVG and PNG (gnuplot)");
  add_overwrite(command, options->replace);
  add_general(command, *options, "Print the results as JSON", kQuietReport);
}

void add_info(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<InfoOptions>(
      parent, work, info, "info", "Describe a file, the OpenCL devices, or the kernel of a scene.",
      "  pillarfield info scenes/demo.toml\n"
      "  pillarfield info --devices\n"
      "  pillarfield info --kernel scenes/demo.toml\n");
  Group input(command, "Input");
  CLI::Option* const file =
      input.text("FILE", options->file, "FILE",
                 "Frames as of solve, force fields, calibration or scene to describe");
  CLI::Option* const devices = input.flag("--devices", options->devices, "List OpenCL devices");
  CLI::Option* const kernel =
      input.text("--kernel", options->kernel, "SCENE",
                 "Print the stages of a scene and the OpenCL C compiled for it");
  add_trust(command, options->read);
  add_plain_data(command, options->read, false);
  file->excludes(devices)->excludes(kernel);
  devices->excludes(kernel);
  add_general(command, *options, "Print as JSON", kQuietReport);
  kernel->excludes(command->get_option("--json"));
}

void add_completion(CLI::App& parent, Work& work) {
  CLI::App* const command =
      parent.add_subcommand("completion", "Print a shell's completion script.");
  command->footer(
      "  pillarfield completion bash >pillarfield.bash\n"
      "  source <(pillarfield completion bash)\n");
  const auto shell = std::make_shared<std::string>();
  const auto words = std::make_shared<std::vector<std::string>>();
  Group input(command, "Input");
  input.text("SHELL", *shell, "SHELL", "bash, zsh or fish")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}, "words"));
  // The scripts call `completion words -- calibrate tare`.
  command->add_option("WORDS", *words)->group("");
  add_help(command);
  command->callback([=, &parent, &work] {
    work = [text = *shell == "words" ? completion_words(parent, *words)
                                     : completion_script(*shell)] { fmt::print("{}", text); };
  });
}

/// Returns the innermost command of a command line.
const CLI::App& called_of(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  return called.empty() ? app : called_of(*called.back());
}

std::string message_of(const CLI::App& command, const CLI::ParseError& error) {
  std::vector<std::string> commands;
  for (const CLI::App* each : command.get_subcommands({})) commands.push_back(each->get_name());
  const std::vector<std::string> left = command.remaining();
  if (left.empty()) {
    if (commands.empty() || dynamic_cast<const CLI::RequiredError*>(&error) == nullptr) {
      return error.what();
    }
    return fmt::format("no command is given; it is one of {}", fmt::join(commands, ", "));
  }
  const std::string word = left.front().substr(0, left.front().find('='));
  if (word.starts_with('-')) {
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    }
    return fmt::format("'{}' is not an option{}", word, suggestion(word, options));
  }
  if (commands.empty()) return fmt::format("'{}' is one argument too many", left.front());
  return fmt::format("'{}' is not a command{}", left.front(), suggestion(word, commands));
}

}  // namespace

Work parse_arguments(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  Work work;
  CLI::App app("Turns frames of a high-density artificial skin into fields of three-axis force.",
               "pillarfield");
  app.formatter_fn([](const CLI::App* command, const std::string&, CLI::AppFormatMode) {
    return help_of(*command);
  });
  app.footer(
      "  pillarfield simulate scenes/demo.toml -o demo.h5\n"
      "  pillarfield solve demo.h5 -o forces.h5\n"
      "  pillarfield compare forces.h5 demo.h5\n");
  add_simulate(app, work);
  add_solve(app, work);
  add_join(app, work);
  add_stream(app, work);
  add_pace(app, work);
  add_body(app, work);
  add_compare(app, work);
  add_calibrate(app, work);
  add_testbed(app, work);
  add_info(app, work);
  add_completion(app, work);
  bool version = false;
  bool json = false;
  Group general(&app, "General");
  CLI::Option* const version_flag =
      general.flag("--version", version, "Print version, build and libraries, and exit");
  general.flag("--json", json, "With --version: print JSON")->needs(version_flag);
  add_help(&app);
  try {
    std::ranges::reverse(words);
    app.parse(words);
    if (version) return [json] { print_version(json); };
    if (!work) throw CLI::RequiredError("COMMAND");
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", help_of(called_of(app)));
    return [] {};
  } catch (const CLI::ParseError& error) {
    const CLI::App& command = called_of(app);
    const std::string name = full_name(command);
    std::string message = message_of(command, error);
    if (!message.ends_with('?')) message += fmt::format("; see '{} --help'", name);
    if (&command == &app) throw WrongCommandLine(message);
    throw WrongCommandLine(name.substr(app.get_name().size() + 1) + ": " + message);
  }
  if (std::string_view(argv[1]) == "live") note_former_name("live", "pace");
  return work;
}

}  // namespace pillarfield::cli
