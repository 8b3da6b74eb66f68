#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_field.h"
#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// Attributes of a file of force fields.
struct ForceFileInfo {
  std::uint32_t rows = 0;  ///< pillar rows
  std::uint32_t cols = 0;  ///< pillar columns
  double pillar_pitch_mm = 0;
  std::string estimator;     ///< "direct", "paper" or "contact"
  std::string device;        ///< device that solved it
  std::string source;        ///< name of the file of frames
  bool angles = false;       ///< holds magnitude, theta and phi
  bool uncertainty = false;  ///< holds the planes of Uncertainty
  std::optional<ContactOptions> contacts =
      {};  ///< holds contacts, found with these options; HDF5 only
  /// SolverPlan::segment_point; HDF5 only. Unset: not stated.
  std::optional<double> segment_point = {};
};

/// Writes solved frames to a file, one by one. It writes to `path` + ".part", which finish()
/// renames. The destructor without finish() removes the part, except an HDF5 file with flushed
/// frames.
class ForceSink {
 public:
  virtual ~ForceSink() = default;

  /// Appends a frame; `time_s` must be finite. Throws Error if it cannot be written.
  virtual void append(const ForceFieldView& forces, double time_s) = 0;

  /// Appends the contacts of the frame appended last. Call it after every append() if
  /// ForceFileInfo::contacts is set, and never otherwise. Throws Error if not, here or at the next
  /// append().
  virtual void append_contacts(const FrameContacts& contacts);

  /// Closes the file and renames the part to its final name.
  virtual void finish() = 0;
};

/// Creates a file of forces, whose ending selects the format: .h5 or .hdf5 ("pillarfield-forces"),
/// .csv (one line per loaded pillar) or .npy (a structured array [frames, rows, cols]). `replace`
/// says which existing file it may replace. Throws Error for another ending or a path that cannot
/// be written.
[[nodiscard]] std::unique_ptr<ForceSink> create_force_sink(const std::filesystem::path& path,
                                                           const ForceFileInfo& info,
                                                           Replace replace = Replace::results);

/// Writes one frame as the .csv that create_force_sink() makes; `frame` and `time_s` are its index
/// and time in its source.
void write_force_csv(const std::filesystem::path& path, const ForceFileInfo& info,
                     const ForceFieldView& forces, std::uint64_t frame, double time_s,
                     Replace replace = Replace::results);

/// The format that create_force_sink() selects. Throws Error for an unknown ending.
[[nodiscard]] OutputKind kind_of_force_file(const std::filesystem::path& path);

/// Whether this is an HDF5 file of force fields; false if it cannot be read.
[[nodiscard]] bool is_force_file(const std::filesystem::path& path,
                                 const ReadOptions& options = {});

/// Reads files of the format "pillarfield-forces" (docs/formats.md), also if their writer was
/// killed.
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
  [[nodiscard]] const std::vector<std::string>& remarks() const;

  /// Reads a frame, with its uncertainty if the file has it, and returns its time, s.
  double read(std::uint64_t index, ForceField& forces) const;

  /// Reads the contacts of a frame. Throws Error if ForceFileInfo::contacts is unset.
  [[nodiscard]] FrameContacts read_contacts(std::uint64_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
