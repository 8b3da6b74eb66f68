// The steps of a calibration: names, arguments, work and facts found. The command and the Python
// package are loops over this table.

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/range.h"
#include "calibration/pressure_log.h"
#include "calibration/wire_correction.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/tare.h"

namespace pillarfield {

/// An argument of a step beside its frames.
struct StepArgument {
  enum class Kind : std::uint8_t {
    number,
    whole,
    flag,
    word,  ///< one of `words`
    log,   ///< a PressureLog
  };
  Kind kind;
  const char* name;  ///< of the option, without its dashes
  const char* unit;  ///< in the help: "RATIO"
  const char* help;  ///< one sentence, with the default in brackets
  Range range = {};  ///< of numbers
  std::vector<std::string> words = {};
  std::size_t count_per_file = 0;  ///< values for each file of frames; 0: one for all
  bool required = false;
  bool is_nonzero = false;

  [[nodiscard]] static StepArgument number(const char* name, const char* unit, const char* help,
                                           Range range) {
    return {Kind::number, name, unit, help, range};
  }
  [[nodiscard]] static StepArgument whole(const char* name, const char* help, Range range) {
    return {Kind::whole, name, "N", help, range};
  }
  [[nodiscard]] static StepArgument flag(const char* name, const char* help) {
    return {Kind::flag, name, "", help};
  }
  [[nodiscard]] static StepArgument word(const char* name, std::vector<std::string> words,
                                         const char* help) {
    return {Kind::word, name, "", help, {}, std::move(words)};
  }
  /// A required value for each file.
  [[nodiscard]] static StepArgument per_file(const char* name, const char* unit, const char* help,
                                             Range range) {
    return {Kind::number, name, unit, help, range, {}, 1, true};
  }
};

/// The values that are given; empty ones are not.
struct StepValues {
  std::map<std::string, std::vector<double>> numbers;  ///< a flag is 1
  std::map<std::string, std::string> words;
  std::vector<PressureLog> logs;
};

/// Frames of one file or array.
struct StepFrames {
  using Use = std::function<void(const FrameView&, double time_s)>;

  std::string file;  ///< empty for an array
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  std::optional<SkinLayout> layout = {};      ///< given beside the frames; unset: that of `skin`
  std::optional<Pitch> sensel_pitch_mm = {};  ///< given beside the frames
  std::vector<std::uint8_t> mask;             ///< as Calibration::mask
  std::uint64_t frames = 0;
  std::function<void(const Use&)> for_each;  ///< calls it with each frame

  [[nodiscard]] std::string name() const { return file.empty() ? "frames" : file; }
};

/// Report of a step. Programs read the facts, people the lines of text.
struct StepReport {  // NOLINT(bugprone-exception-escape): JSON's move constructor does not throw
  std::string headline;
  nlohmann::ordered_json facts;
  std::vector<std::string> measures;
  std::vector<std::string> notes;     ///< after the findings
  std::vector<std::string> warnings;  ///< each begins with the file

  /// Adds a fact and its line; a unit that begins with "%" scales the value by 100 in the line.
  void measure(const char* fact, double value, const char* label, const std::string& unit);
  /// Adds the sensels that a step finds faulty.
  void add(const SkinCalibration& calibration, const std::vector<SenselFinding>& findings);
  /// Adds the residual error that a step stored, if any.
  void add_residual(const SensorEffects& effects);
};

/// Use that a step may make of the wires in the calibration that it extends.
enum class WireUse : std::uint8_t {
  loaded,    ///< crosstalk is removed
  unloaded,  ///< nothing touches the skin: tares that are an offset behind the wires stay
  none,      ///< the step finds the wires
};

/// A step at work.
class StepWork {  // NOLINT(bugprone-exception-escape): as StepReport
 public:
  SkinCalibration before;
  std::vector<StepFrames> files;
  StepValues values;
  StepReport report;
  std::string parameters;  ///< for the history

  [[nodiscard]] std::uint64_t frames() const;                         ///< of all files
  [[nodiscard]] std::vector<double> numbers(const char* name) const;  ///< empty: not given
  [[nodiscard]] double number(const char* name, double otherwise) const;
  [[nodiscard]] std::optional<std::string> word(const char* name) const;

  [[nodiscard]] WireCorrection correction(const StepFrames& file, WireUse use) const;
  /// Calls `use` with the frames of a file, without the crosstalk of known wires.
  void for_each(const StepFrames& file, const StepFrames::Use& use) const;
  /// Statistics of each file.
  [[nodiscard]] std::vector<FrameStatistics> statistics(WireUse use = WireUse::loaded) const;
  /// Frames of each file, of the unloaded skin.
  [[nodiscard]] std::vector<TareFrames> unloaded_frames() const;
};

/// A step of the table.
struct StepKind {
  enum class Before : std::uint8_t { none, optional, required };

  const char* name;
  const char* summary;
  const char* frames;  ///< name of the argument of frames
  const char* frames_help;
  SkinCalibration (*run)(StepWork&);
  bool is_single = false;               ///< takes one file
  bool uses_times = false;              ///< of the frames
  std::optional<SkinLayout> only = {};  ///< the layout of the skins that it is for; unset: any
  Before before = Before::required;
  const char* before_help = "Calibration to extend";
  std::vector<StepArgument> arguments = {};
  std::vector<const char*> examples = {};  ///< of the command, without the program's name
};

/// All steps, in the order of the help.
[[nodiscard]] const std::vector<StepKind>& calibration_steps();

/// Throws Error where values are missing, out of range, or not one for each file.
void check(const StepKind& step, const StepValues& values, std::size_t files, std::size_t logs);

struct StepResult {
  SkinCalibration calibration;  ///< with this step in its history
  StepReport report;
};

/// Runs a step on `before`, or on a blank calibration of the skin; the sensels that files lack are
/// masked. Throws Error where frames, values and calibration do not fit.
[[nodiscard]] StepResult run_step(const StepKind& step, std::vector<StepFrames> files,
                                  std::optional<SkinCalibration> before, StepValues values);

// Commands of several examples.
inline constexpr const char* kSimulateIdle =
    "simulate scenes/calibration/new_skin_idle.toml --uncalibrated -o idle.h5";
inline constexpr const char* kSimulatePressed =
    "simulate scenes/calibration/new_skin_pressed.toml --uncalibrated -o pressed.h5";
inline constexpr const char* kTareIdle = "calibrate tare idle.h5 -o tared.h5";
inline constexpr const char* kEquilibratePressed =
    "calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration tared.h5 -o equal.h5";

}  // namespace pillarfield
