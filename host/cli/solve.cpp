// pillarfield solve: force fields from frames.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/region_count.h"
#include "cli/stopwatch.h"
#include "cli/warnings.h"
#include "io/file_kind.h"
#include "pillarfield/contact_file.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/processor.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/recording.h"
#include "pillarfield/solve_range.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "skin/status_word.h"

namespace pillarfield::cli {
namespace {

/// Returns the table of contacts, unless contacts go into the force file alone. Throws Error where
/// they cannot be written as the options name them.
std::optional<PlannedOutput> contact_table(const SolveOptions& options) {
  const std::string& file = options.contacts_file;
  if (file.empty()) return std::nullopt;
  check(options.contacts, "the command line");
  if (!options.output.empty() && name_same_file(file, options.output)) {
    if (options.pressure_unit != kPressureUnits.front()) {
      throw Error(file, fmt::format("pressures in HDF5 are in {}", kPressureUnits.front().name),
                  "write the contacts to a .csv or .json, or leave out --pressure-unit");
    }
    if (is_hdf5_name(options.output)) return std::nullopt;
    throw Error(file, "forces and contacts cannot share this file",
                "name another file for contacts");
  }
  if (is_hdf5_name(file)) {
    throw Error(file, "contacts cannot be written in this format",
                fmt::format("end it in {}, or name the .h5 file of forces",
                            endings_of(OutputKind::contacts)));
  }
  return planned_contact_file(file);
}

/// The frames in contact, and the one of the largest normal force.
struct LoadSummary {
  std::uint64_t frames = 0;  ///< in contact
  double largest_n = 0;      ///< sum over the frame
  double at_s = 0;           ///< its time
};

struct SolveSummary {
  PipelineStatistics done;
  RegionCount regions;
  LoadSummary load;
  double startup_seconds = 0;  ///< opening the files and the device, compiling
  double seconds = 0;          ///< reading, solving and writing, which overlap
};

/// The settings of the file, then of the command line.
SolverPlan plan_of(const SolveOptions& options, FrameSource& source) {
  return cli::plan_of(options.plan, plan_of_frames(source), options.input,
                      [&] { return frame_interval_of(source, options.input); });
}

ForceFileInfo file_info(const SolveOptions& options, const SolverPlan& plan, const Device& device) {
  ForceFileInfo info =
      file_info(plan, device.info().name, std::filesystem::path(options.input).filename().string());
  if (!options.contacts_file.empty() && is_hdf5_name(options.output)) {
    info.contacts = options.contacts;
  }
  return info;
}

constexpr int kFramesInFlight = 3;

/// Sum of the normal forces of loaded pillars, N; most words of the status have none.
double loaded_normal_n(const ForceFieldView& forces) {
  double sum = 0;
  const std::size_t elements = forces.status.size();
  for (std::size_t first = 0; first < elements; first += kWordBytes) {
    const std::size_t end = std::min(first + kWordBytes, elements);
    std::uint64_t word = 0;
    std::memcpy(&word, &forces.status[first], end - first);
    if ((word & kEachByte * status::kLoaded) == 0) continue;
    for (std::size_t i = first; i < end; ++i) {
      if (std::isfinite(forces.normal[i])) sum += static_cast<double>(forces.normal[i]);
    }
  }
  return sum;
}

/// Counts regions, finds the frame of the largest force and shows the progress.
class Counter final : public ForceSink {
 public:
  Counter(std::uint64_t frames, bool quiet) : progress_("Solving", frames, quiet) {}

  void append(const SolvedFrame& frame) override {
    const std::uint64_t in_contact = regions_.in_contact();
    regions_.add(frame.forces.status);
    progress_.show(++frames_);
    if (regions_.in_contact() == in_contact) return;
    ++load_.frames;
    const double normal_n =
        frame.contacts != nullptr ? frame.contacts->total.normal_n : loaded_normal_n(frame.forces);
    if (normal_n <= load_.largest_n) return;
    load_.largest_n = normal_n;
    load_.at_s = frame.time_s;
  }
  [[nodiscard]] const RegionCount& regions() const { return regions_; }
  [[nodiscard]] const LoadSummary& load() const { return load_; }

 private:
  Progress progress_;
  RegionCount regions_;
  LoadSummary load_;
  std::uint64_t frames_ = 0;
};

double per_second(double amount, double seconds) { return seconds > 0 ? amount / seconds : 0; }

void print_json(const SolveOptions& options, const SolverPlan& plan, const Device& device,
                const SolveSummary& summary, const FrameSource& source) {
  nlohmann::ordered_json json = {{"input", options.input},
                                 {"output", options.output},
                                 {"estimator", name_of(estimator_of(plan))},
                                 {"device", device.info().name},
                                 {"zero_copy", device.info().shares_memory},
                                 {"stages", kernel_stages(plan)},
                                 {"frames", summary.done.frames},
                                 {"layout", name_of(plan.skin.layout)}};
  if (plan.skin.has_pillars()) {
    json["pillar_rows"] = plan.skin.pillar_rows();
    json["pillar_cols"] = plan.skin.pillar_cols();
    for (const Region region :
         {Region::none, Region::one, Region::two, Region::three, Region::four, Region::opposite}) {
      json["regions"][name_of(region)] = summary.regions.of(region);
    }
    json["resolved"] = summary.regions.resolved;
  } else {
    json["sensel_rows"] = plan.skin.rows;
    json["sensel_cols"] = plan.skin.cols;
    json["in_contact"] = summary.regions.in_contact();
  }
  json["frames_in_contact"] = summary.load.frames;
  json["largest_normal_n"] = summary.load.largest_n;
  json["largest_at_s"] = summary.load.at_s;
  json["saturated"] = summary.regions.saturated;
  json["inconsistent"] = summary.regions.inconsistent;
  json["startup_seconds"] = summary.startup_seconds;
  json["seconds"] = summary.seconds;
  json["warnings"] = source.warnings();
  json["notes"] = source.notes();
  if (!options.contacts_file.empty()) {
    json["contacts_output"] = options.contacts_file;
    json["contacts"] = summary.done.contacts;
    json["contacts_at_once"] = summary.done.most_contacts;
  }
  fmt::print("{}\n", json_text(json));
}

/// Sentences on contacts and the largest force, and the next command.
std::string story_of(const SolveOptions& options, const SolveSummary& summary) {
  const LoadSummary& load = summary.load;
  if (load.frames == 0) return "Nothing touches in any frame\n";
  std::string contacts;
  if (!options.contacts_file.empty()) {
    contacts = fmt::format(", {}, at most {} at once", counted(summary.done.contacts, "contact"),
                           summary.done.most_contacts);
  }
  std::string story =
      fmt::format("Contact in {} of {}{}; largest normal force {:.4g} N in all, at {:.{}g} s\n",
                  grouped(load.frames), counted(summary.done.frames, "frame"), contacts,
                  load.largest_n, load.at_s, load.at_s < 1e4 ? 4 : 13);
  if (is_hdf5_name(options.output)) {
    story += fmt::format("Look at it: pillarfield-viewer {}\n", printable(options.output));
  }
  return story;
}

void print_text(const SolveOptions& options, const SolverPlan& plan, const Device& solver,
                const SolveSummary& summary) {
  const RegionCount& regions = summary.regions;
  const auto frames = static_cast<double>(summary.done.frames);
  const auto elements = static_cast<double>(regions.all());
  const char* const name = name_of(plan.skin.layout);
  const DeviceInfo& device = solver.info();
  fmt::print("Solved {} of {} x {} {} on {} ({}, {})\n", counted(summary.done.frames, "frame"),
             plan.skin.element_rows(), plan.skin.element_cols(), name, device.name, device.type,
             device.shares_memory ? "zero copy" : "staged");
  fmt::print("{}", story_of(options, summary));
  fmt::print("  reading, solving, writing  {:.2f} s, {} frames/s, {:.3g} million {}/s\n",
             summary.seconds, rounded(per_second(frames, summary.seconds)),
             per_second(elements, summary.seconds) / 1e6, name);
  fmt::print("  opening, compiling         {:.2f} s\n", summary.startup_seconds);
  fmt::print("In contact: {} of {} {} ({}){}\n", grouped(regions.in_contact()),
             grouped(regions.all()), name, percent(regions.in_contact(), regions.all()),
             plan.skin.has_pillars() ? ", of which" : "");
  for (const Region region : kContactRegions) {
    if (!plan.skin.has_pillars()) break;
    fmt::print("  {:<9} {:>7}  {}\n",
               region == Region::opposite ? "opposite" : fmt::format("region {}", name_of(region)),
               percent(regions.of(region), regions.in_contact()), meaning_of(region));
  }
  if (const auto absent = count_absent_elements(plan.calibration, plan.skin)) {
    fmt::print("No sensel: {} of the {} {} of a frame\n", grouped(absent),
               grouped(plan.skin.elements()), name);
  }
  if (estimator_of(plan) == Estimator::contact) {
    fmt::print("Resolved by the friction of their contacts: {} of {} pillars of region 3\n",
               grouped(regions.resolved), grouped(regions.of(Region::three)));
  }
  if (plan.skin.has_pillars()) {
    fmt::print(
        "Flagged: {} with a saturated sensel, {} with a missing sensel or inconsistent readings\n",
        grouped(regions.saturated), grouped(regions.inconsistent));
  } else {
    fmt::print("Flagged: {} saturated, {} missing\n", grouped(regions.saturated),
               grouped(regions.inconsistent));
  }
  if (!options.contacts_file.empty()) {
    fmt::print("Contacts: {} in all, at most {} at once, in {}\n", grouped(summary.done.contacts),
               summary.done.most_contacts, printable(options.contacts_file));
  }
  if (!options.output.empty()) fmt::print("Wrote {}\n", printable(options.output));
}

/// Inputs of a solve.
struct Job {
  const SolveOptions& options;
  FrameSource& source;
  const Device& device;
  const SolverPlan& plan;
  RangeOptions range;
  Counter& counter;
  ReadingCheck& check;
};

/// Solves the frames into the outputs of the options.
void solve_frames(const Job& job, const std::optional<PlannedOutput>& table,
                  SolveSummary& summary) {
  const SolveOptions& options = job.options;
  ForceFileInfo info = file_info(options, job.plan, job.device);
  const FrameRange frames = options.frames.value_or(FrameRange{0, job.source.frames()});
  info.frames = frames.end - frames.first;
  info.first_frame = frames.first;
  std::vector<std::unique_ptr<ForceSink>> files;
  if (!options.output.empty()) {
    files.push_back(create_force_sink(options.output, info, options.replace));
  }
  if (table) {
    files.push_back(create_contact_sink(
        table->path,
        {info.element_pitch_mm, info.source, options.contacts, info.layout, options.pressure_unit},
        options.replace));
  }
  std::vector<ForceSink*> sinks = {&job.counter, &job.check};
  for (const auto& file : files) sinks.push_back(file.get());
  summary.done = solve_range(job.source, job.device, job.plan, frames, job.range, sinks);
  if (summary.done.stopped) {
    stop_if_interrupted(summary.done.frames,
                        options.output.empty() ? options.contacts_file : options.output);
  }
  for (const auto& file : files) file->finish();
}

/// The files that this process writes.
std::vector<PlannedOutput> outputs_of(const SolveOptions& options,
                                      const std::optional<PlannedOutput>& table) {
  std::vector<PlannedOutput> outputs;
  if (!options.output.empty()) outputs.push_back(planned_force_file(options.output));
  if (table) outputs.push_back(*table);
  return outputs;
}

/// True if an output is a folder, for a file of each input.
bool is_folder(const std::string& output) {
  std::error_code ignored;
  return output.ends_with('/') || std::filesystem::is_directory(output, ignored);
}

/// A file in this folder with the name of an input. Throws Error if another input has that name, or
/// `output` is not a folder.
std::string output_of(const std::filesystem::path& input, const std::string& output,
                      const char* ending, std::set<std::string>& outputs) {
  if (output.empty()) return {};
  std::string name = (std::filesystem::path(output) / input.stem()).string() + ending;
  if (is_folder(output) && outputs.insert(name).second) return name;
  throw Error(output, fmt::format("holds one result, and {} is not the only input", input.string()),
              "name folders, and inputs of different names");
}

void solve_series(SolveOptions options, const std::vector<std::filesystem::path>& files) {
  options.input = options.inputs.front();
  while (options.input.size() > 1 && options.input.ends_with('/')) options.input.pop_back();
  const Stopwatch watch;
  const std::optional<PlannedOutput> table = contact_table(options);
  std::vector<std::filesystem::path> inputs = files;
  inputs.insert(inputs.end(), {options.plan.scene, options.plan.calibration});
  check_outputs(inputs, outputs_of(options, table), options.replace);
  const std::unique_ptr<FrameSource> source =
      open_frames_with_warnings(options.inputs, frame_options(options.plan), options.quiet);
  if (options.frames && options.frames->end > source->frames()) {
    throw Error(options.input, "has " + counted(source->frames(), "frame"),
                fmt::format("give --frames within 1:{}", source->frames()));
  }
  SolverPlan plan = plan_of(options, *source);
  print_about(options.input, "warning", allow_for_errors(plan, *source));
  set_sensor(options.contacts, plan);
  const Device device = open_device(options.device).for_plan(plan);
  RangeOptions range;
  range.warm_up = options.warm_up;
  range.processor = {.frames_in_flight = kFramesInFlight,
                     .on_compiling = terminal_line(options.quiet)};
  if (!options.contacts_file.empty()) range.contacts = options.contacts;
  SolveSummary summary;
  ReadingCheck check(plan);
  range.stop = [&, started = false]() mutable {
    // Called first when all is compiled.
    if (!std::exchange(started, true)) summary.startup_seconds = watch.seconds();
    return is_interrupted();
  };
  {
    const auto frames = options.frames.value_or(FrameRange{0, source->frames()});
    Counter counter(frames.end - frames.first, options.quiet);
    const Job job = {options, *source, device, plan, range, counter, check};
    solve_frames(job, table, summary);
    summary.regions = counter.regions();
    summary.load = counter.load();
  }
  summary.seconds = watch.seconds() - summary.startup_seconds;
  if (!source->has_truth()) print_about(options.input, "warning", check.warnings());
  if (options.json) {
    print_json(options, plan, device, summary, *source);
  } else if (!options.quiet) {
    print_text(options, plan, device, summary);
  }
}

}  // namespace

void solve(const SolveOptions& options) {
  const std::vector<std::filesystem::path> files =
      series_files({options.inputs.begin(), options.inputs.end()});
  if (!is_folder(options.output) && !is_folder(options.contacts_file)) {
    return solve_series(options, files);
  }
  std::set<std::string> outputs;
  std::vector<SolveOptions> solves(files.size(), options);
  for (std::size_t i = 0; i < files.size(); ++i) {
    solves[i].inputs = {files[i].string()};
    solves[i].output = output_of(files[i], options.output, ".h5", outputs);
    solves[i].contacts_file = output_of(files[i], options.contacts_file, ".csv", outputs);
  }
  for (const std::string& folder : {options.output, options.contacts_file}) {
    if (!folder.empty()) std::filesystem::create_directories(folder);
  }
  for (const SolveOptions& each : solves) solve_series(each, {each.inputs.front()});
}

}  // namespace pillarfield::cli
