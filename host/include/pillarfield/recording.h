#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Frames from a file, whatever its format.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const std::string& format() const = 0;  ///< "recording" or "Tekscan ASCII"
  [[nodiscard]] virtual const Skin& skin() const = 0;
  [[nodiscard]] virtual SenselType sensel_type() const = 0;
  [[nodiscard]] virtual std::uint64_t frames() const = 0;
  [[nodiscard]] virtual const Calibration& calibration() const = 0;
  [[nodiscard]] virtual bool has_truth() const = 0;

  /// Time of frame `index`, seconds. Reads no readings.
  virtual double time(std::uint64_t index) = 0;

  /// Reads frame `index` into `frame` (of this skin and type) and returns its time in seconds.
  virtual double read(std::uint64_t index, FrameBuffer& frame) = 0;

  /// Reads the true forces of frame `index`, [pillar rows, cols], newtons; its status is left as it
  /// is. Only where has_truth().
  virtual void read_truth(std::uint64_t index, ForceField& truth) = 0;

  /// What a user should know of this file, one sentence each: a row or column without pillars, a
  /// file that was never closed, a constant that was assumed.
  [[nodiscard]] virtual const std::vector<std::string>& remarks() const = 0;
};

/// Opens a recording (HDF5) or a Tekscan ASCII export, told apart by content, not by name. A
/// recording whose writer was killed, or still writes, gives the frames flushed so far.
/// Throws Error where the file is neither, is damaged, or holds values out of range.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                                       const ReadOptions& options = {});

/// Writes a recording, format "pillarfield-recording" version 1 (docs/formats.md).
///
/// Frames go to `path` + ".part", which takes the final name in finish(). If the process dies, the
/// part holds every flushed frame and open_frames() reads it. A writer destroyed without finish()
/// leaves the part where frames are in it and removes it where none are. A part with frames that an
/// earlier writer left is never overwritten.
class RecordingWriter {
 public:
  struct Options {
    bool truth = false;                  ///< frames come with their truth
    std::uint32_t flush_every = 16;      ///< frames, at least 1
    Replace replace = Replace::results;  ///< a recording is replaced with Replace::anything only
  };
  RecordingWriter(const std::filesystem::path& path, const Skin& skin, SenselType type,
                  const Calibration& calibration, const Options& options);
  ~RecordingWriter();
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;

  /// Appends a frame of the skin's size and type; `truth` is given exactly where the options say.
  void append(const FrameView& frame, double time_s, const ForceField* truth = nullptr);

  /// Makes all frames appended so far safe against the death of the process.
  void flush();

  /// Flushes, closes, and gives the file its final name.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
