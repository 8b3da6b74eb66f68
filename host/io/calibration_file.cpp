#include "pillarfield/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "io/hdf5/readers.h"
#include "io/recording_format.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Limit for damaged files; a real history has about ten steps.
constexpr int kMaxSteps = 10000;

Skin size_of_skin(const SkinCalibration& calibration) {
  Skin skin;
  skin.rows = calibration.rows;
  skin.cols = calibration.cols;
  return skin;
}

std::string group_of_step(int number) {
  return fmt::format("{}/{}", calibration_format::kHistory, number);
}

// Writing

void write_step(const hdf5::File& file, const std::string& name, const CalibrationStep& step) {
  const hdf5::Handle group = hdf5::create_group(file, name.c_str());
  const auto write = [&](const char* attribute, const auto& value) {
    hdf5::write_attribute(file, group.get(), attribute, value);
  };
  write(calibration_format::kStep, step.step);
  write(calibration_format::kSources, fmt::format("{}", fmt::join(step.sources, "\n")));
  constexpr std::uint64_t kMaxFrames = std::numeric_limits<int>::max();
  write(calibration_format::kStepFrames, static_cast<int>(std::min(step.frames, kMaxFrames)));
  write(calibration_format::kParameters, step.parameters);
  write(calibration_format::kDate, step.date_utc);
  write(calibration_format::kProgramVersion, step.program_version);
}

void write_history(const hdf5::File& file, const std::vector<CalibrationStep>& history) {
  if (history.empty()) return;
  const hdf5::Handle group = hdf5::create_group(file, calibration_format::kHistory);
  int number = 0;
  for (const CalibrationStep& step : history) write_step(file, group_of_step(++number), step);
}

void write_all(const hdf5::File& file, const SkinCalibration& calibration) {
  hdf5::write_attribute(file, file.id.get(), "format", std::string(calibration_format::kName));
  hdf5::write_attribute(file, file.id.get(), "version", calibration_format::kVersion);
  const hdf5::Handle skin =
      write_skin(file, {calibration.sensel_pitch_mm, calibration.counts_per_newton,
                        calibration.threshold_counts, std::nullopt, calibration.power_law,
                        calibration.layout, calibration.falling});
  hdf5::write_attribute(file, skin.get(), calibration_format::kRows,
                        static_cast<int>(calibration.rows));
  hdf5::write_attribute(file, skin.get(), calibration_format::kCols,
                        static_cast<int>(calibration.cols));
  if (calibration.threshold_factor) {
    hdf5::write_attribute(file, skin.get(), calibration_format::kThresholdFactor,
                          *calibration.threshold_factor);
  }
  write_planes(file, size_of_skin(calibration), calibration.planes);
  write_history(file, calibration.history);
}

// Reading

std::uint32_t read_size(const hdf5::File& file, hid_t skin, const char* name) {
  const auto size = hdf5::read_number(file, skin, name);
  if (size && *size >= 2 && *size <= kMaxSensels && *size == std::floor(*size)) {
    return static_cast<std::uint32_t>(*size);
  }
  const std::string what =
      size ? fmt::format("{} is {}", name, *size) : fmt::format("has no attribute '{}'", name);
  throw Error(fmt::format("{}: {}", file.path.string(), recording_format::kSkin), what,
              fmt::format("it must be a whole number in [2, {}]", kMaxSensels));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

CalibrationStep read_step(const hdf5::File& file, const std::string& name) {
  const hdf5::Handle group = hdf5::open_object(file, name.c_str());
  const auto text = [&](const char* attribute) {
    return hdf5::read_text(file, group.get(), attribute).value_or("");
  };
  CalibrationStep step;
  step.step = text(calibration_format::kStep);
  step.sources = lines_of(text(calibration_format::kSources));
  const double frames =
      hdf5::read_number(file, group.get(), calibration_format::kStepFrames).value_or(0);
  // NaN and values above 2^53 are not counts.
  step.frames = frames >= 0 && frames < 0x1p53 ? static_cast<std::uint64_t>(frames) : 0;
  step.parameters = text(calibration_format::kParameters);
  step.date_utc = text(calibration_format::kDate);
  step.program_version = text(calibration_format::kProgramVersion);
  return step;
}

std::vector<CalibrationStep> read_history(const hdf5::File& file) {
  std::vector<CalibrationStep> history;
  for (int number = 1; number <= kMaxSteps; ++number) {
    const std::string name = group_of_step(number);
    if (!hdf5::exists(file, name)) break;
    history.push_back(read_step(file, name));
  }
  return history;
}

}  // namespace

bool is_calibration_file(const std::filesystem::path& path) {
  const hdf5::QuietErrors quiet;
  try {
    const hdf5::File file = hdf5::open_to_read(InputFile(path), false);
    return hdf5::read_text(file, file.id.get(), "format") == calibration_format::kName;
  } catch (const Error&) {
    return false;
  }
}

SkinCalibration read_calibration_file(const std::filesystem::path& path,
                                      const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  return read_calibration(hdf5::open_to_read(InputFile(path), options.trust));
}

SkinCalibration read_calibration(const hdf5::File& file) {
  hdf5::require_format(file, calibration_format::kName, calibration_format::kVersion);
  const hdf5::Handle skin = open_skin(file);
  if (!skin.valid()) throw Error(file.path.string(), "has no /skin", hdf5::kDamaged);
  SkinCalibration calibration;
  calibration.rows = read_size(file, skin.get(), calibration_format::kRows);
  calibration.cols = read_size(file, skin.get(), calibration_format::kCols);
  const StoredSkin constants = read_skin(file);
  calibration.sensel_pitch_mm = constants.sensel_pitch_mm;
  calibration.counts_per_newton = constants.counts_per_newton;
  calibration.threshold_counts = constants.threshold_counts;
  calibration.power_law = constants.power_law;
  calibration.layout = constants.layout;
  calibration.falling = constants.falling;
  calibration.threshold_factor =
      hdf5::read_number(file, skin.get(), calibration_format::kThresholdFactor);
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
