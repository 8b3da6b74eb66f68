#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_field.h"
#include "pillarfield/force_sink.h"
#include "pillarfield/output_file.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/read_options.h"
#include "pillarfield/sensor_effects.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Attributes of a file of force fields.
struct ForceFileInfo {
  std::uint32_t rows = 0;  ///< of elements: pillars, or sensels without pillars
  std::uint32_t cols = 0;
  Pitch element_pitch_mm;
  std::string estimator;     ///< "direct", "paper" or "contact"
  std::string device;        ///< device that solved it
  std::string source;        ///< name of the file of frames
  bool angles = false;       ///< holds magnitude, theta and phi
  bool uncertainty = false;  ///< holds the planes of Uncertainty
  bool pressure = false;     ///< holds the pressure, which follows from normal force and pitch
  std::optional<ContactOptions> contacts =
      {};  ///< holds contacts, found with these options; HDF5 only
  /// SolverPlan::segment_point; HDF5 only. Unset: not stated.
  std::optional<double> segment_point = {};
  SensorEffects effects = {};               ///< of the skin's calibration; HDF5 only
  std::optional<Surface> surface = {};      ///< of the skin; HDF5 only
  std::uint64_t first_frame = 0;            ///< of the source, where a range was solved; HDF5 only
  SkinLayout layout = SkinLayout::pillars;  ///< without pillars: normal force alone
  PressureUnit pressure_unit = kPressureUnits.front();  ///< of contacts in CSV and JSON
  std::uint64_t frames = 0;  ///< how many it will hold, if known, which keeps small files small
};

/// Metadata for a file of the plan's forces, without contacts. `device` and `source` are names.
[[nodiscard]] ForceFileInfo file_info(const SolverPlan& plan, const std::string& device,
                                      const std::string& source);

/// Creates a sink in the format of the extension of `path` (docs/formats.md; endings_of() lists
/// them). `replace` limits which existing file it may replace. Throws Error for another extension
/// or a path that cannot be written.
///
/// Files are written to `path` + ".part", which finish() renames to `path`. The destructor without
/// finish() removes the part, except for an HDF5 file with flushed frames. If
/// ForceFileInfo::contacts is set, each frame must have contacts, which are also written.
[[nodiscard]] std::unique_ptr<ForceSink> create_force_sink(const std::filesystem::path& path,
                                                           const ForceFileInfo& info,
                                                           Replace replace = Replace::results);

/// Writes one frame as the .csv of create_force_sink(); `frame` and `time_s` are its index and time
/// in its source.
void write_force_csv(const std::filesystem::path& path, const ForceFileInfo& info,
                     const ForceFieldView& forces, std::uint64_t frame, double time_s,
                     Replace replace = Replace::results);

/// The output of create_force_sink() for this path, for check_outputs(). Throws Error for another
/// extension.
[[nodiscard]] PlannedOutput planned_force_file(const std::filesystem::path& path);

/// True if this is an HDF5 file of force fields; false if it cannot be read.
[[nodiscard]] bool is_force_file(const std::filesystem::path& path);

/// Reads files of the format "pillarfield-forces" (docs/formats.md), including those of a killed
/// writer.
class ForceFileReader {
 public:
  /// Throws Error if the file is of another format or damaged.
  explicit ForceFileReader(const std::filesystem::path& path, const ReadOptions& options = {});
  ~ForceFileReader();
  ForceFileReader(ForceFileReader&&) noexcept;
  ForceFileReader& operator=(ForceFileReader&&) noexcept;

  [[nodiscard]] const ForceFileInfo& info() const;
  [[nodiscard]] std::uint64_t frames() const;  ///< number of frames
  /// Warnings about the file, one sentence each.
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  /// Reads a frame, with its uncertainty if the file has it, and returns its time, s.
  double read(std::uint64_t index, ForceField& forces) const;

  /// Reads the contacts of a frame. Throws Error if ForceFileInfo::contacts is unset.
  [[nodiscard]] FrameContacts read_contacts(std::uint64_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
