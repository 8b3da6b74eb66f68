#include "pillarfield/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "io/hdf5/crash_guard.h"
#include "io/hdf5/file.h"
#include "io/hdf5/readers.h"
#include "io/recording_format.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"
#include "skin/skin_fields.h"

namespace pillarfield {
namespace {

constexpr const char* kHistory = "/history";
constexpr const char* kRows = "rows";
constexpr const char* kCols = "cols";

/// Limit for damaged files; a real history has about ten steps.
constexpr int kMaxSteps = 10000;

Skin size_of_skin(const SkinCalibration& calibration) {
  Skin skin;
  skin.rows = calibration.rows;
  skin.cols = calibration.cols;
  return skin;
}

std::string group_of_step(int number) { return fmt::format("{}/{}", kHistory, number); }

/// Visits the attributes of a step, visit(name, member).
template <class Step, class Visit>
void visit_step(Step& step, Visit visit) {
  visit("step", step.step);
  visit("sources", step.sources);
  visit("frames", step.frames);
  visit("parameters", step.parameters);
  visit("date_utc", step.date_utc);
  visit("program_version", step.program_version);
}

struct StepWriter {
  void operator()(const char* name, const std::string& text) const { to.write(name, text); }
  void operator()(const char* name, const std::vector<std::string>& lines) const {
    to.write(name, fmt::format("{}", fmt::join(lines, "\n")));
  }
  void operator()(const char* name, std::uint64_t count) const {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    to.write(name, static_cast<int>(std::min(count, kMost)));
  }
  hdf5::Attributes to;
};

struct StepReader {
  void operator()(const char* name, std::string& text) const {
    text = from.text(name).value_or("");
  }
  void operator()(const char* name, std::vector<std::string>& lines) const {
    const std::string text = from.text(name).value_or("");
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  void operator()(const char* name, std::uint64_t& count) const {
    const double number = from.number(name).value_or(0);
    // NaN and values above 2^53 are not counts.
    count = number >= 0 && number < 0x1p53 ? static_cast<std::uint64_t>(number) : 0;
  }
  hdf5::Attributes from;
};

void write_history(const hdf5::File& file, const std::vector<CalibrationStep>& history) {
  if (history.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, kHistory);
  int number = 0;
  for (const CalibrationStep& step : history) {
    const hdf5::Handle place = hdf5::create_group(file, group_of_step(++number).c_str());
    visit_step(step, StepWriter{{file, place.get()}});
  }
}

void write_all(const hdf5::File& file, const SkinCalibration& calibration) {
  const hdf5::Attributes root(file);
  root.write("format", std::string(calibration_format::kName));
  root.write("version", calibration_format::kVersion);
  const hdf5::Handle group = write_skin(file, calibration);
  const hdf5::Attributes skin(file, group.get());
  skin.write(kRows, static_cast<int>(calibration.rows));
  skin.write(kCols, static_cast<int>(calibration.cols));
  skin.write(kThresholdFactor.name, calibration.threshold_factor);
  write_planes(file, size_of_skin(calibration), calibration.planes);
  write_history(file, calibration.history);
}

std::uint32_t read_size(const hdf5::File& file, const hdf5::Attributes& skin, const char* name) {
  const auto size = skin.number(name);
  if (size && *size >= 1 && *size <= kMaxSensels && *size == std::floor(*size)) {
    return static_cast<std::uint32_t>(*size);
  }
  const std::string what =
      size ? fmt::format("{} is {}", name, *size) : fmt::format("has no attribute '{}'", name);
  throw Error(fmt::format("{}: {}", file.path.string(), kSkinGroup), what,
              fmt::format("it must be a whole number in [1, {}]", kMaxSensels));
}

std::vector<CalibrationStep> read_history(const hdf5::File& file) {
  std::vector<CalibrationStep> history;
  for (int number = 1; number <= kMaxSteps; ++number) {
    const std::string name = group_of_step(number);
    if (!hdf5::exists(file, name)) break;
    const hdf5::Handle group = hdf5::open_object(file, name.c_str());
    visit_step(history.emplace_back(), StepReader{{file, group.get()}});
  }
  return history;
}

}  // namespace

bool is_calibration_file(const std::filesystem::path& path) {
  return hdf5::format_of(path) == calibration_format::kName;
}

SkinCalibration read_calibration_file(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  const hdf5::CrashGuard guard(path, options.trust, hdf5::CrashGuard::kNoLimit);
  return read_calibration(hdf5::open_to_read(InputFile(path), options.trust));
}

SkinCalibration read_calibration(const hdf5::File& file) {
  hdf5::require_format(file, calibration_format::kName, calibration_format::kVersion);
  const hdf5::Handle group = open_skin(file);
  if (!group.valid()) throw Error(file.path.string(), "has no /skin", hdf5::kDamaged);
  const hdf5::Attributes skin(file, group.get());
  SkinCalibration calibration;
  calibration.rows = read_size(file, skin, kRows);
  calibration.cols = read_size(file, skin, kCols);
  read_skin(file, calibration);
  calibration.threshold_factor = skin.number(kThresholdFactor.name);
  calibration.planes = read_planes(file, size_of_skin(calibration));
  calibration.history = read_history(file);
  check(calibration, file.path.c_str());
  return calibration;
}

void write_calibration_file(const std::filesystem::path& path, const SkinCalibration& calibration,
                            Replace replace) {
  const hdf5::QuietErrors quiet;
  check(calibration, path.c_str());
  OutputFile part(path, OutputKind::calibration, replace);
  hdf5::File file = hdf5::create(part);
  write_all(file, calibration);
  hdf5::flush(file);
  hdf5::close(file);
  part.commit();
}

}  // namespace pillarfield
