#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/options/argument_group.h"
#include "solve/plan_settings.h"

// Arguments of several commands.
namespace pillarfield::cli {

using Work = std::function<void()>;

inline constexpr const char* kQuietWriter = "Print only errors, warnings and the output of --json";
inline constexpr const char* kQuietReport = "Show no progress";

/// Scenes store seeds as integers of TOML.
inline constexpr std::uint64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();

/// Message about a wrong command line of `command`, whose whole name is `name`: the misspelt word
/// with a suggestion, or CLI11's words and where the help is.
[[nodiscard]] std::string complaint_of(const CLI::App& command, const CLI::ParseError& error,
                                       const std::string& name);

void add_help(CLI::App* command);
void add_general(CLI::App* command, PrintOptions& options, const char* json, const char* quiet);
void add_overwrite(CLI::App* command, Replace& replace);
void add_output(CLI::App* command, WriteOptions& options, const std::string& description);
void add_trust(CLI::App* command, ReadOptions& options);
/// Adds what files of plain numbers leave open; --rate if the command uses the times of frames.
void add_plain_data(CLI::App* command, ReadOptions& options, bool uses_times);
void add_tare_frames(CLI::App* command, ReadOptions& options);
void add_setting(CLI::App* command, const PlanSetting& setting, PlanSettings& settings);
/// Adds the settings that the viewer has, too.
void add_shown_settings(CLI::App* command, PlanSettings& settings);
void add_sensor(CLI::App* command, PlanOptions& plan);
void add_solver(CLI::App* command, PlanOptions& plan);
std::array<CLI::Option*, 2> add_contacts(CLI::App* command, ContactOptions& options);
void add_device(CLI::App* command, std::string& name);
/// Adds --pressure-unit.
CLI::Option* add_pressure_unit(Group& group, PressureUnit& unit);

/// Adds a command; its options live as long as the work.
template <class Options>
std::pair<CLI::App*, std::shared_ptr<Options>> add_command(CLI::App& parent, Work& work,
                                                           void (*run)(const Options&),
                                                           const char* name,
                                                           const char* description,
                                                           const std::string& examples) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = parent.add_subcommand(name, description);
  command->footer(examples);
  command->callback([=, &work] { work = [=] { run(*options); }; });
  return {command, options};
}

void add_stream(CLI::App& parent, Work& work);
void add_control(CLI::App& parent, Work& work);
void add_doctor(CLI::App& parent, Work& work);

/// Adds `calibrate` and its steps.
void add_calibrate(CLI::App& parent, Work& work);

}  // namespace pillarfield::cli
