#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/array_axes.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Size of a frame, sensels.
struct FrameSize {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
};

/// Options of opening a file for reading. All but `trust` concern frames: open_frames() uses them.
struct ReadOptions {
  /// The file comes from a trusted source, such as your own programs. Frames of other files have at
  /// most 8,388,608 sensels.
  bool trust = false;

  /// Array of frames in an HDF5 file or an .npz archive. Empty: the readings of a recording, the
  /// only array of frames of an archive.
  std::string dataset = {};
  /// One-dimensional array of the frames' times, s, in that file. Empty: `time` of an archive.
  std::string times = {};
  /// Size of a frame whose readings lie in one line of a table or array.
  std::optional<FrameSize> frame_size = {};
  /// Columns of a table that are its readings, in their order in a frame: names, patterns with '*'
  /// and '?', numbers from 1 on and ranges of them, separated by commas: "pressure_*", "2-97",
  /// "1-96:2". The numbers in names order what rises, and what one part names. Empty: all whose
  /// names are no times, row numbers, sums, labels or other measures.
  std::string columns = {};
  /// Lines of a table that are read: those with this word in a column, "side=L". Empty: all.
  std::string where = {};
  /// Order of the axes of an array of plain data. Empty: frames, rows, columns; an array that more
  /// likely has another order is refused (require_likely_axes()).
  std::vector<ArrayAxis> axes = {};

  /// Frames per second, for a file without times, or with times that tie or step back: frame i has
  /// the time i / rate_hz. Throws Error for a file whose times rise, unless `untimed`. Without it,
  /// times that do not rise are kept in the order of the file, with a warning.
  std::optional<double> rate_hz = {};
  /// The caller needs no times: without a rate, those of a file without times are NaN.
  bool untimed = false;

  /// Unit of the numbers of plain data, such as "kPa", "psi", "mmHg", "N/cm2" or "N", or "counts",
  /// in place of the one that the file states: readings become newtons, a pressure by the area of a
  /// sensel. Empty: the unit that the file states, else counts.
  std::string readings = {};

  /// Constants of the skin, in place of those in the file.
  std::optional<Pitch> sensel_pitch_mm = {};
  std::optional<double> counts_per_newton = {};
  std::optional<double> threshold_counts = {};
  std::optional<double> full_scale_counts = {};
  /// Layout in place of the file's; plain data and Tekscan exports, which state none, have
  /// SkinLayout::sensels.
  std::optional<SkinLayout> layout = {};
  /// Readings fall under load, as those of dividers whose lower resistor is the sensel: frames are
  /// mirrored as they are read. A recording that says so itself is mirrored already.
  bool falling = false;

  /// Number of first frames, of the unloaded skin, from which take_tare() measures tare, noise and
  /// threshold in place of those in the file; at least kLeastTareFrames. 0: none.
  std::uint64_t tare_frames = 0;
};

/// The version of the HDF5 library, as "1.10.8".
[[nodiscard]] std::string hdf5_version();

}  // namespace pillarfield
