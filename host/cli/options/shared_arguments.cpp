#include "cli/options/shared_arguments.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <system_error>

#include "base/nearest_word.h"
#include "pillarfield/error.h"
#include "pillarfield/skin.h"
#include "pillarfield/tare.h"
#include "skin/limits.h"
#include "solve/plan_settings.h"

namespace pillarfield::cli {
namespace {

/// Reads the size of a frame, such as "40x60".
FrameSize frame_size_of(const std::string& text) {
  FrameSize size;
  const char* const end = text.data() + text.size();
  const auto rows = std::from_chars(text.data(), end, size.rows);
  if (rows.ec == std::errc{} && rows.ptr != end && *rows.ptr == 'x') {
    const auto cols = std::from_chars(rows.ptr + 1, end, size.cols);
    const auto fits = [](std::uint32_t each) { return each >= 1 && each <= kMaxSensels; };
    if (cols.ec == std::errc{} && cols.ptr == end && fits(size.rows) && fits(size.cols))
      return size;
  }
  throw CLI::ValidationError(
      "--shape",
      fmt::format("'{}' is not ROWSxCOLS of 1 to {} each, such as 40x60", text, kMaxSensels));
}

Pitch pitch_of(const std::string& text) {
  if (const auto pitch = parse_pitch(text)) return *pitch;
  throw CLI::ValidationError(
      "--pitch-mm",
      fmt::format("'{}' is not a distance of 0.001 to 1000 mm, such as 5, nor that from row to row "
                  "and from column to column, such as 7.62x5.08",
                  text));
}

std::vector<ArrayAxis> axes_of(const std::string& text) {
  try {
    return parse_axes(text);
  } catch (const Error& error) {
    throw CLI::ValidationError("--axes", fmt::format("{}; {}", error.failure(), error.mend()));
  }
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

std::string complaint_of(const CLI::App& command, const CLI::ParseError& error,
                         const std::string& name) {
  std::string message = message_of(command, error);
  if (!message.ends_with('?')) message += fmt::format("; see '{} --help'", name);
  return message;
}

void add_help(CLI::App* command) {
  command->set_help_flag("-h,--help", "Print this help and exit")->group("General");
}

void add_general(CLI::App* command, PrintOptions& options, const char* json, const char* quiet) {
  Group general(command, "General");
  general.flag("--json", options.json, json);
  general.flag("-q,--quiet", options.quiet, quiet);
  add_help(command);
}

void add_overwrite(CLI::App* command, Replace& replace) {
  command
      ->add_flag_callback(
          "--overwrite", [&replace] { replace = Replace::anything; },
          "Replace an existing output of any kind; inputs are never replaced")
      ->group("Output");
}

void add_output(CLI::App* command, WriteOptions& options, const std::string& description) {
  Group(command, "Output").text("-o,--output", options.output, "FILE", description)->required();
  add_overwrite(command, options.replace);
}

void add_trust(CLI::App* command, ReadOptions& options) {
  Group(command, "Input")
      .flag("--trust-input", options.trust,
            "The files are your own: read frames of any size, and leave crashes to the system");
}

void add_plain_data(CLI::App* command, ReadOptions& options, bool uses_times) {
  options.untimed = !uses_times;
  Group plain(command, "Plain data");
  plain.text("--dataset", options.dataset, "NAME",
             "Array of frames in an HDF5 file or .npz archive [the only one]");
  plain.text(
      "--times", options.times, "NAME",
      "Array of their times in that file, seconds [time of an archive]; column of times of a "
      "table, by name or number");
  command
      ->add_option_function<std::string>(
          "--shape", [&](const std::string& text) { options.frame_size = frame_size_of(text); },
          "Sensels of a frame whose readings lie in one line")
      ->type_name("ROWSxCOLS")
      ->group("Plain data");
  plain.text("--columns", options.columns, "LIST",
             "Columns of a table that are readings, by name or number: 'pressure_*', 2-97, 1-96:2 "
             "[all but times, row numbers, sums and labels]");
  plain.text("--where", options.where, "COLUMN=WORD",
             "Lines of a table that are read: those with this word in the column, side=L [all]");
  plain.text(
      "--readings", options.readings, "UNIT",
      "Unit of the numbers: kPa, psi, mmHg, N/cm2, N, ..., or counts [the file's, else counts]");
  command
      ->add_option_function<std::string>(
          "--axes", [&](const std::string& text) { options.axes = axes_of(text); },
          "Order of the array's axes: frames, rows and columns, separated by commas "
          "[frames,rows,columns]")
      ->type_name("WORDS")
      ->group("Plain data");
  if (uses_times) {
    plain.number("--rate", options.rate_hz, "HZ", "Frames per second, if the file has no times",
                 1e-6, 1e9);
  }
  plain.choice(
      "--layout", options.layout, kLayouts,
      "pillars: one on each 2 x 2 sensels, three components of force; sensels: "
      "none, normal force and pressure on each [the file's or sensor's; without a word sensels]");
  plain.flag("--falling", options.falling,
             "Readings fall under load: they are mirrored, 255 or 65535 less the reading");
  command
      ->add_option_function<std::string>(
          "--pitch-mm", [&](const std::string& text) { options.sensel_pitch_mm = pitch_of(text); },
          "Distance between neighbouring sensels: 5, or 7.62x5.08 where rows lie 7.62 mm apart and "
          "columns 5.08 mm [the file's]")
      ->type_name("MM")
      ->group("Plain data");
}

void add_tare_frames(CLI::App* command, ReadOptions& options) {
  Group(command, "Input")
      .whole("--tare-frames", options.tare_frames, "N",
             "Measure tare, noise and threshold in the first N frames, without load [the file's]",
             kLeastTareFrames, std::numeric_limits<std::uint32_t>::max());
}

void add_setting(CLI::App* command, const PlanSetting& setting, PlanSettings& settings) {
  Group group(command, setting.heading);
  std::optional<double>& target = settings.*setting.member;
  const auto& [low, high, open_low, open_high] = setting.range;
  if (setting.has(kIsWhole)) {
    group.whole(setting.option, target, setting.unit, setting.help, static_cast<std::uint64_t>(low),
                static_cast<std::uint64_t>(high));
  } else {
    group.number(setting.option, target, setting.unit, setting.help, low, high);
  }
}

void add_shown_settings(CLI::App* command, PlanSettings& settings) {
  for (const PlanSetting& setting : kPlanSettings) {
    if (setting.has(kIsShown)) add_setting(command, setting, settings);
  }
}

CLI::Option* add_pressure_unit(Group& group, PressureUnit& unit) {
  std::vector<std::pair<std::string, PressureUnit>> choices;
  choices.reserve(std::size(kPressureUnits));
  for (const PressureUnit& each : kPressureUnits) choices.emplace_back(each.name, each);
  return group.choice<PressureUnit>("--pressure-unit", unit, choices,
                                    "Unit of pressures in the output [kPa]");
}

}  // namespace pillarfield::cli
