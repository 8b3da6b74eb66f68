// The command line: every command's options in groups, their help and its examples.

#include "cli/options/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/nearest_word.h"
#include "base/reworded.h"
#include "cli/commands.h"
#include "cli/options/argument_group.h"
#include "cli/options/help.h"
#include "cli/options/shared_arguments.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

void add_simulate(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<SimulateOptions>(
      parent, work, simulate, "simulate",
      "Make a recording from a scene: frames of the sensor and the true forces.",
      "  pillarfield simulate scenes/demo.toml -o demo.h5\n"
      "  pillarfield simulate scenes/touch/sliding.toml -o noisy.h5 --frames 20 --seed 7\n");
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

/// The range of FIRST:LAST, counted from 1; unset for another text.
std::optional<FrameRange> range_of(const std::string& text) {
  FrameRange range;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != ':') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.end);
  if (last.ec != std::errc{} || last.ptr != end) return std::nullopt;
  if (range.first == 0 || range.end < range.first) return std::nullopt;
  --range.first;
  return range;
}

void add_range(CLI::App* command, SolveOptions& options) {
  constexpr const char* kGroup = "Range";
  command
      ->add_option_function<std::string>(
          "--frames", [&options](const std::string& text) { options.frames = range_of(text); },
          "Solve only these frames, counted from 1 [all]")
      ->type_name("FIRST:LAST")
      ->group(kGroup)
      ->check([](const std::string& text) {
        return range_of(text) ? "" : fmt::format("'{}' is not FIRST:LAST, counted from 1", text);
      });
  Group(command, kGroup)
      .whole("--warm-up", options.warm_up, "FRAMES",
             "Frames before these that are solved first, for what frames leave to the next ones "
             "[3 s, or 3 time constants of baseline and creep; none if nothing is left]",
             0, 1'000'000'000);
}

void add_solve(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<SolveOptions>(
      parent, work, solve, "solve",
      "Turn frames into fields of force: three axes for each pillar, or, without pillars, the "
      "normal force on each sensel, in newtons.",
      "  pillarfield simulate scenes/demo.toml -o demo.h5\n"
      "  pillarfield solve demo.h5 -o forces.h5\n"
      "  pillarfield solve demo.h5 -o forces.npy --outputs angles,uncertainty --noise 0.5\n"
      "  pillarfield solve demo.h5 -o forces.h5 --contacts contacts.csv\n");
  Group input(command, "Input");
  input
      .text("INPUT", options->inputs, "FILE",
            "Recording (HDF5), Tekscan ASCII export, or plain data: .npy, .npz, CSV, HDF5 dataset; "
            "several files, or a folder, are one source in order of names")
      ->required();
  add_tare_frames(command, options->plan.read);
  add_plain_data(command, options->plan.read, true);
  Group(command, "Output")
      .text("-o,--output", options->output, "FILE",
            "Force fields; the ending sets the format: " + endings_of(OutputKind::forces) +
                "; a folder gets one .h5 of each input [none, with --contacts]");
  command->parse_complete_callback([chosen = options] {
    if (!chosen->output.empty() || !chosen->contacts_file.empty()) return;
    throw CLI::RequiredError("--output, the forces of all elements, or --contacts, their totals,");
  });
  add_overwrite(command, options->replace);
  add_sensor(command, options->plan);
  add_solver(command, options->plan);
  Group contacts(command, "Contacts");
  CLI::Option* const file =
      contacts.text("--contacts", options->contacts_file, "FILE",
                    "Track contacts and write force, centre of pressure, area and pressure of each "
                    "and of the patch: " +
                        endings_of(OutputKind::contacts) + "; the .h5 of --output holds them too");
  for (CLI::Option* const option : add_contacts(command, options->contacts)) option->needs(file);
  add_pressure_unit(contacts, options->pressure_unit)->needs(file);
  add_range(command, *options);
  add_device(command, options->device);
  add_general(command, *options, "Print the summary as JSON", kQuietWriter);
}

void add_compare(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<CompareOptions>(
      parent, work, compare, "compare", "Compare solved forces with the truth by region.",
      "  pillarfield simulate scenes/touch/sliding.toml -o sliding.h5\n"
      "  pillarfield solve sliding.h5 -o sliding_forces.h5\n"
      "  pillarfield compare sliding_forces.h5 sliding.h5\n"
      "  pillarfield compare sliding_forces.h5 sliding.h5 --json\n");
  Group input(command, "Input");
  input.file("FORCES", options->forces, "Force fields of solve (.h5)");
  input.file("RECORDING", options->recording, "Recording that they were solved from, with truth");
  add_trust(command, options->read);
  add_general(command, *options, "Print the table as JSON", kQuietReport);
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
  CLI::Option* const devices =
      input.flag("--devices", options->devices, "List devices: the host and those of OpenCL");
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

/// The command that the words after "help" name.
const CLI::App& topic_of(const CLI::App& app, std::span<const std::string> words) {
  if (words.empty() || words.front().starts_with('-')) return app;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) {
    known.push_back(command->get_name());
    if (known.back() == words.front()) return topic_of(*command, words.subspan(1));
  }
  throw WrongCommandLine(fmt::format("help: '{}' is not a command{}", words.front(),
                                     suggestion(words.front(), known)));
}

/// Returns the innermost command of a command line.
const CLI::App& called_of(const CLI::App& app) {
  const std::vector<CLI::App*> called = app.get_subcommands();
  return called.empty() ? app : called_of(*called.back());
}

/// The options of a command by the names that the library has for what they set.
Rewording option_names(const CLI::App& command) {
  Rewording names;
  for (const PlanSetting& setting : kPlanSettings) {
    if (setting.option == nullptr) continue;
    if (command.get_option_no_throw(setting.option) != nullptr) {
      names.emplace_back(setting.name, setting.option);
    }
  }
  return names;
}

}  // namespace

Work parse_arguments(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
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
  add_stream(app, work);
  add_control(app, work);
  add_compare(app, work);
  add_doctor(app, work);
  add_calibrate(app, work);
  add_info(app, work);
  add_completion(app, work);
  bool version = false;
  bool json = false;
  Group general(&app, "General");
  CLI::Option* const version_flag =
      general.flag("--version", version, "Print version, build and libraries, and exit");
  general.flag("--json", json, "With --version: print JSON")->needs(version_flag);
  add_help(&app);
  const std::string first = words.empty() ? "" : words.front();
  if (first == "help" || first == "-h" || first == "--help") {
    const std::string text = help_of(topic_of(app, std::span(words).subspan(1)));
    return [text] { fmt::print("{}", text); };
  }
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
    const std::string message = complaint_of(command, error, name);
    if (&command == &app) throw WrongCommandLine(message);
    throw WrongCommandLine(name.substr(app.get_name().size() + 1) + ": " + message);
  }
  return [work, words = option_names(called_of(app))] {
    try {
      work();
    } catch (const Error& error) {
      throw reworded(error, words);
    }
  };
}

}  // namespace pillarfield::cli
