#include "calibration/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/nearest_word.h"
#include "pillarfield/error.h"

namespace pillarfield {

// Each is defined in the file of its step.
StepKind wires_step();
StepKind tare_step();
StepKind equilibrate_step();
StepKind load_step();
StepKind shear_step();
StepKind arm_step();
StepKind leak_step();
StepKind memory_step();
StepKind bending_step();
StepKind faults_step();
StepKind weight_step();

namespace {

void check_number(const StepArgument& argument, double value) {
  if (argument.range.contains(value) && (value != 0 || !argument.is_nonzero)) return;
  throw Error(
      argument.name, fmt::format("it is {:g}", value),
      fmt::format("give {}{}", argument.range.text(), argument.is_nonzero ? " other than 0" : ""));
}

void check_word(const StepArgument& argument, const std::string& word) {
  if (std::ranges::find(argument.words, word) != argument.words.end()) return;
  throw Error(argument.name, fmt::format("'{}' is not a choice", word),
              fmt::format("give {}{}", fmt::join(argument.words, " or "),
                          suggestion(word, argument.words)));
}

std::size_t count(const StepArgument& argument, const StepValues& values, std::size_t logs) {
  if (argument.kind == StepArgument::Kind::log) return logs;
  const auto found = values.numbers.find(argument.name);
  return found == values.numbers.end() ? 0 : found->second.size();
}

void check_count(const StepArgument& argument, std::size_t given, std::size_t files) {
  if (given == argument.count_per_file * files || (given == 0 && !argument.required)) return;
  throw Error(argument.name, fmt::format("{} files and {} values", files, given),
              fmt::format("give {} per file", argument.count_per_file == 1 ? "one" : "two"));
}

std::vector<std::string> names_of(const std::vector<StepFrames>& files) {
  std::vector<std::string> names;
  for (const StepFrames& each : files) {
    if (!each.file.empty()) names.push_back(std::filesystem::path(each.file).filename().string());
  }
  return names;
}

}  // namespace

void StepReport::measure(const char* fact, double value, const char* label,
                         const std::string& unit) {
  facts[fact] = value;
  const double scale = unit.starts_with('%') ? 100 : 1;
  measures.push_back(fmt::format("  {:<12} {:9.2f} {}", label, scale * value, unit));
}

void StepReport::add(const SkinCalibration& calibration,
                     const std::vector<SenselFinding>& findings) {
  facts["masked"] = count_masked(calibration.planes) + count_absent(calibration.planes);
  auto& list = facts["findings"] = nlohmann::ordered_json::array();
  for (const SenselFinding& finding : findings) {
    list.push_back({{"row", finding.row},
                    {"col", finding.col},
                    {"fault", name_of(finding.fault)},
                    {"masked", finding.masked},
                    {"mean_counts", finding.mean_counts}});
  }
}

void StepReport::add_residual(const SensorEffects& effects) {
  if (!effects.residual) return;
  const auto& [relative, offset_counts] = *effects.residual;
  facts["residual_relative"] = relative;
  facts["residual_offset_counts"] = offset_counts;
  notes.push_back(
      fmt::format("Left: {:.2f} % of a reading and {:.2f} counts", 100 * relative, offset_counts));
}

std::uint64_t StepWork::frames() const {
  std::uint64_t sum = 0;
  for (const StepFrames& each : files) sum += each.frames;
  return sum;
}

std::vector<double> StepWork::numbers(const char* name) const {
  const auto found = values.numbers.find(name);
  return found == values.numbers.end() ? std::vector<double>() : found->second;
}

double StepWork::number(const char* name, double otherwise) const {
  const std::vector<double> given = numbers(name);
  return given.empty() ? otherwise : given.front();
}

std::optional<std::string> StepWork::word(const char* name) const {
  const auto found = values.words.find(name);
  if (found == values.words.end() || found->second.empty()) return std::nullopt;
  return found->second;
}

WireCorrection StepWork::correction(const StepFrames& file, WireUse use) const {
  const Calibration& known = before.planes;
  return {file.name(), file.skin, file.sensel_type,
          use == WireUse::none ? std::nullopt : known.effects.wires,
          use == WireUse::loaded ? known.tare : std::vector<float>()};
}

void StepWork::for_each(const StepFrames& file, const StepFrames::Use& use) const {
  WireCorrection correct = correction(file, WireUse::loaded);
  file.for_each([&](const FrameView& raw, double time_s) { use(correct(raw), time_s); });
}

std::vector<FrameStatistics> StepWork::statistics(WireUse use) const {
  std::vector<FrameStatistics> all;
  for (const StepFrames& each : files) {
    WireCorrection correct = correction(each, use);
    FrameStatistics& statistics = all.emplace_back(each.name(), correct.skin(), correct.type());
    each.for_each([&](const FrameView& raw, double) { statistics.add(correct(raw)); });
  }
  return all;
}

std::vector<TareFrames> StepWork::unloaded_frames() const {
  std::vector<TareFrames> all;
  for (const StepFrames& each : files) {
    WireCorrection correct = correction(each, WireUse::unloaded);
    TareFrames& frames = all.emplace_back(each.name(), correct.skin(), correct.type());
    each.for_each([&](const FrameView& raw, double) { frames.add(correct(raw)); });
  }
  return all;
}

const std::vector<StepKind>& calibration_steps() {
  static const std::vector<StepKind> steps = {
      wires_step(), tare_step(),   equilibrate_step(), load_step(),   shear_step(), arm_step(),
      leak_step(),  memory_step(), bending_step(),     faults_step(), weight_step()};
  return steps;
}

void check(const StepKind& step, const StepValues& values, std::size_t files, std::size_t logs) {
  if (files == 0) throw Error(step.name, "there are no frames", "give some");
  for (const StepArgument& argument : step.arguments) {
    if (argument.count_per_file > 0) check_count(argument, count(argument, values, logs), files);
    const auto word = values.words.find(argument.name);
    if (word != values.words.end() && !word->second.empty()) {
      check_word(argument, word->second);
    }
    const auto numbers = values.numbers.find(argument.name);
    if (numbers == values.numbers.end() || argument.kind == StepArgument::Kind::flag) continue;
    for (const double value : numbers->second) check_number(argument, value);
  }
}

namespace {

/// Layout and pitch that are given, else those of the calibration, else those of the frames.
void take_constants(const StepKind& step, StepWork& work) {
  std::optional<SkinLayout>& layout = work.before.layout;
  std::optional<Pitch>& pitch_mm = work.before.sensel_pitch_mm;
  for (StepFrames& each : work.files) {
    if (each.layout) layout = each.layout;
    each.skin.layout = layout.value_or(each.skin.layout);
    if (each.sensel_pitch_mm) pitch_mm = each.sensel_pitch_mm;
    if (!pitch_mm && each.skin.states_pitch()) pitch_mm = each.skin.sensel_pitch_mm;
    each.skin.sensel_pitch_mm = pitch_mm.value_or(each.skin.sensel_pitch_mm);
    if (!step.only || *step.only == each.skin.layout) continue;
    const bool needs_pillars = *step.only == SkinLayout::pillars;
    throw Error(each.name(),
                fmt::format("the step {} needs {}, and the skin has {}", step.name,
                            needs_pillars ? "pillars" : "sensels without pillars",
                            needs_pillars ? "none" : "pillars"),
                fmt::format("leave the step out, or give the layout {}", name_of(*step.only)));
  }
}

}  // namespace

StepResult run_step(const StepKind& step, std::vector<StepFrames> files,
                    std::optional<SkinCalibration> before, StepValues values) {
  check(step, values, files.size(), values.logs.size());
  std::vector<std::string> warnings;
  if (!before || !before->layout) warnings = layout_warnings(files.front().skin);
  StepWork work;
  work.before = before ? *std::move(before) : blank_calibration(files.front().skin);
  work.files = std::move(files);
  work.values = std::move(values);
  take_constants(step, work);
  for (const StepFrames& each : work.files) {
    require_fitting(work.before, each.skin, each.name());
    mask_missing(work.before, each.mask);
  }
  SkinCalibration calibration = step.run(work);
  std::ranges::move(warnings, std::back_inserter(work.report.warnings));
  calibration.history.push_back(
      step_done(step.name, names_of(work.files), work.frames(), work.parameters));
  return {std::move(calibration), std::move(work.report)};
}

}  // namespace pillarfield
