#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/steps.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/output_file.h"
#include "pillarfield/plan_builder.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/processor.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/solve_range.h"

/// The commands and their arguments. A command throws Error where its work fails.
namespace pillarfield::cli {

/// build_plan() with the files of the options; prints the warnings of a scene. A `source` that is a
/// scene is applied too. Throws Error where a file cannot be read or does not fit.
[[nodiscard]] SolverPlan plan_of(PlanOptions options, SolverPlan plan, const std::string& source,
                                 const std::function<double()>& frame_interval_s);

struct PrintOptions {
  bool json = false;
  bool quiet = false;  ///< no progress, and no summary of a written file
};

struct WriteOptions : PrintOptions {
  std::string output;
  Replace replace = Replace::results;
};

struct SimulateOptions : WriteOptions {
  std::string scene;
  std::optional<std::uint32_t> frames;
  std::optional<std::uint64_t> seed;
  bool uncalibrated = false;
};

struct SolveOptions : WriteOptions {
  std::vector<std::string> inputs;  ///< files and folders
  std::string input;                ///< the one, or the first; set by solve()
  PlanOptions plan;
  std::string device;         ///< for open_device()
  std::string contacts_file;  ///< empty: none
  ContactOptions contacts;
  PressureUnit pressure_unit = kPressureUnits.front();  ///< of the table of contacts
  std::optional<FrameRange> frames;                     ///< unset: all
  std::optional<std::uint64_t> warm_up;                 ///< RangeOptions::warm_up
};

struct StreamOptions : PrintOptions {
  std::string source;
  std::optional<double> rate_hz;  ///< of a replayed file, or of the sensor
  bool repeat = false;
  bool summary = false;  ///< measures whether the solver keeps up with rate_hz
  bool newest = false;   ///< of the frames that wait, the newest alone
  std::uint32_t serial_baud = 2'000'000;
  std::vector<std::string> sinks;
  std::vector<std::string> allowed_origins;  ///< of web pages
  std::string record;                        ///< file of raw frames; empty: none
  std::string relay;                         ///< ring of raw frames; empty: none
  std::string control;                       ///< socket, "-" for standard input, empty: none
  Replace replace = Replace::results;
  double tare_s = 0;  ///< duration of a tare at the start; 0: none
  std::optional<double> seconds;
  std::optional<std::uint64_t> frames;
  std::optional<double> most_idle_s;  ///< end when no frame came for this time
  double health_interval_s = 1;
  int frames_in_flight = 2;
  ContactOptions contacts;
  PlanOptions plan;
  std::string device;  ///< for open_device()
};

/// A line of control for a running stream.
struct ControlOptions {
  std::string socket;
  std::vector<std::string> words;
};

struct CompareOptions : PrintOptions {
  std::string forces;
  std::string recording;
  ReadOptions read;
};

/// Arguments of all calibration steps.
struct StepOptions : WriteOptions {
  std::string calibration;  ///< file to extend, or empty
  ReadOptions read;
};

struct StepCommand : StepOptions {
  const StepKind* step = nullptr;
  std::vector<std::string> files;
  std::vector<std::string> logs;  ///< of the pressure, one per file
  StepValues values;
};

struct ApplyCommand : StepOptions {
  std::string recording;
};

/// Describes a file, the devices, the kernel of a scene, or with none of these the program.
struct InfoOptions : PrintOptions {
  std::string file;
  std::string kernel;
  ReadOptions read;
  bool devices = false;
};

/// Looks at frames of a file or of a live source.
struct DoctorOptions : PrintOptions {
  std::string source;
  ReadOptions read;
  double seconds = 10;  ///< of a live source
  std::uint32_t serial_baud = 2'000'000;
};

void simulate(const SimulateOptions& options);
void solve(const SolveOptions& options);
void stream(const StreamOptions& options);
void control(const ControlOptions& options);
void compare(const CompareOptions& options);
void calibrate(const StepCommand& command);
void calibrate(const ApplyCommand& command);
void info(const InfoOptions& options);
void doctor(const DoctorOptions& options);

/// Prints version, commit, compiler and libraries.
void print_version(bool json);

}  // namespace pillarfield::cli
