#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Frames of a file of any format, with random access. Indices count from 0.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The format's name in messages.
  [[nodiscard]] virtual const std::string& format() const = 0;
  [[nodiscard]] virtual const Skin& skin() const = 0;
  [[nodiscard]] virtual SenselType sensel_type() const = 0;
  [[nodiscard]] virtual std::uint64_t frames() const = 0;  ///< number of frames
  [[nodiscard]] virtual const Calibration& calibration() const = 0;
  [[nodiscard]] virtual bool has_truth() const = 0;

  /// Time of a frame, s. Does not read the frame.
  virtual double time(std::uint64_t index) = 0;

  /// Reads a frame into `frame`, which must have this skin's size and type, and returns its time,
  /// s.
  virtual double read(std::uint64_t index, FrameBuffer& frame) = 0;

  /// Reads the true forces of a frame, one of each element, N; leaves `truth.status` as it is.
  /// Only if has_truth().
  virtual void read_truth(std::uint64_t index, ForceField& truth) = 0;

  /// Notes about the file, one sentence each: what plain data, which states neither axes nor type,
  /// was read as, or where a tare is from.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }

  /// Warnings about the file, one sentence each: a row or column without pillars, a file that was
  /// not closed, a constant that is assumed.
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;
};

/// Opens a recording (HDF5), a Tekscan ASCII export or plain data (docs/formats.md): .npy, .npz,
/// a table of numbers, an HDF5 dataset; or the files of a folder, as below. The content
/// decides, not the name. If its writer was killed or still writes, a recording has the frames
/// flushed so far. Frames are read on demand, except those of text files and compressed arrays.
/// Throws Error if the file is none of these, is damaged, holds values out of range, or contradicts
/// the options.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                                       const ReadOptions& options = {});

/// Opens several files, and the files of folders, as one source: their frames in natural order of
/// the files' names, in which frame_2 comes before frame_10. Throws Error too if a file differs
/// from the first in size, layout, constants or calibration.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames(
    const std::vector<std::filesystem::path>& paths, const ReadOptions& options = {});

/// Writes a recording, format "pillarfield-recording" (docs/formats.md).
///
/// Writes to `path` + ".part", which finish() renames to `path`. If the process dies, open_frames()
/// reads every flushed frame from the part. The destructor without finish() keeps a part that has
/// frames and removes an empty one. A part with frames that an earlier writer left is never
/// overwritten.
class RecordingWriter {
 public:
  struct Options {
    bool truth = false;                  ///< each frame comes with its true forces
    std::uint32_t flush_every = 16;      ///< frames between flushes, at least 1
    Replace replace = Replace::results;  ///< only Replace::anything replaces a recording
    bool missing = false;                ///< frames may lack sensels
  };
  /// Creates the part. Throws Error if a constant is out of range or the file cannot be written.
  RecordingWriter(const std::filesystem::path& path, const Skin& skin, SenselType type,
                  const Calibration& calibration, const Options& options);
  ~RecordingWriter();
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;

  /// Appends a frame of the skin's size and type. Pass `truth` if and only if Options::truth is
  /// set. Throws Error if the frame does not fit or cannot be written.
  void append(const FrameView& frame, double time_s, const ForceField* truth = nullptr);

  /// The same for a frame in which the blocks `missing` did not arrive: their sensels are NaN if
  /// readings are float32, else they keep the values of `frame`, and readers of the file warn. Only
  /// with Options::missing.
  void append_incomplete(const FrameView& frame, double time_s,
                         std::span<const SenselBlock> missing);

  /// Replaces the threshold of the file and, where the file and `calibration` have them, the planes
  /// tare and noise. Throws Error if the recording was created without a tare, or a value is out of
  /// range.
  void set_tare(const Calibration& calibration, double threshold_counts);

  /// Writes all frames so far to the file, so that they survive the death of the process.
  void flush();

  /// Flushes, closes, and renames the part to its final name.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
