#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// The direction of readings under load.
enum class Polarity : std::uint8_t { rises, falls, unknown };

/// A fault of an array.
enum class ArrayFault : std::uint8_t {
  absent,              ///< sensels without a reading, or that always read 0 where all others do not
  dead,                ///< sensels that do not respond although their neighbours do
  weak,                ///< sensels that respond far less than their neighbours and than most
  stuck,               ///< sensels whose reading is constant while those of the others vary
  saturated,           ///< sensels that are at full scale most of the time
  noisy,               ///< sensels that vary far more than the others without load
  dead_row,            ///< a row of dead, absent or stuck sensels
  dead_column,         ///< the same for a column
  shorted_rows,        ///< two rows that show the same contacts
  shorted_columns,     ///< the same for columns
  row_order,           ///< rows that are wired in another order than they lie
  column_order,        ///< the same for columns
  ghosts,              ///< sensels that read only while the other corners of a rectangle do
  rest_after_release,  ///< sensels that stay up after releases: rest, or a load nobody sees
  followed_baseline,   ///< sensels that go below rest at releases: the board follows its baseline
  missing_frames,      ///< frames without readings of their own: NaN, or one value everywhere
  repeated_frames,     ///< frames that repeat the one before
  frozen,              ///< all frames are equal
  normalised,          ///< every frame has the same largest reading
  two_values,          ///< sensels read one of two values only
  byte_order,          ///< the two bytes of a reading are swapped
};

/// "absent", "dead", "dead row", ...
[[nodiscard]] const char* name_of(ArrayFault fault);
[[nodiscard]] const char* name_of(Polarity polarity);

/// A place, [row, col]; rows and columns count from 0.
using SenselPlace = std::pair<std::uint32_t, std::uint32_t>;

/// A fault, its places and its figure.
struct ArrayFinding {
  ArrayFault fault = ArrayFault::dead;
  std::vector<SenselPlace> sensels = {};  ///< of faults of sensels
  std::vector<std::uint32_t> lines = {};  ///< rows or columns of faults of lines
  /// absent, stuck, saturated: median reading, counts. dead and dead lines: largest response in
  /// per cent of that of the neighbours. Shorted lines: difference of the lines in per cent of
  /// their signal. Order: number of lines out of place. noisy: multiple of the noise of the others.
  /// ghosts: largest reading, counts. Rests: change from before the touch, counts. Frames: their
  /// number. normalised, two_values: the largest reading. byte_order: change from frame to frame in
  /// per cent of the range.
  double figure = 0;
  std::size_t releases = 0;  ///< of rests: releases of a sensel
  std::size_t seen = 0;      ///< of rests: releases after which the rest was another
  /// One sentence for people, with the figure and the place.
  std::string text = {};
};

/// A time without frames.
struct FrameGap {
  std::uint64_t frame = 0;  ///< the frame after it, from 0
  double time_s = 0;        ///< of that frame
  double length_s = 0;      ///< since the frame before it
};

/// The times of frames.
struct FrameTiming {
  std::optional<double> rate_hz = {};  ///< of the median interval; unset: there are no times
  double jitter_ms = 0;                ///< standard deviation of the intervals, without gaps
  std::vector<FrameGap> gaps = {};     ///< the first ones, over 1.5 median intervals each
  std::uint64_t gap_count = 0;
  std::uint64_t lost = 0;  ///< frames for which there is room in the gaps
};

/// A figure of the whole array, and its worst sensel.
struct SenselFigure {
  double median = 0;
  double worst = 0;
  SenselPlace place = {};
};

/// The result of Doctor.
struct Diagnosis {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  SenselType type = SenselType::u8;
  std::uint64_t frames = 0;
  std::uint64_t kept = 0;  ///< frames that were looked at for more than their statistics
  FrameTiming timing = {};
  Polarity polarity = Polarity::unknown;
  double idle_counts = 0;   ///< median reading of sensels without load
  SenselFigure noise = {};  ///< counts
  /// Counts per minute. Unset: fewer than 30 s of frames without a contact, or no times.
  std::optional<SenselFigure> drift = {};
  double contact_counts = 0;         ///< largest change of a frame under load, median of the frames
  std::uint64_t contact_frames = 0;  ///< kept frames with a contact
  std::uint64_t idle_frames = 0;     ///< first frames without a contact
  std::uint64_t clipped = 0;  ///< sensels that were at full scale in some frames, not in most
  std::vector<SenselPlace> untouched = {};   ///< sensels that differ, but nothing tested
  std::vector<SenselPlace> touch_here = {};  ///< a few of these, far apart
  std::uint64_t never_differ = 0;            ///< sensels without two different readings
  SkinLayout layout = SkinLayout::sensels;   ///< as the frames state it
  bool row_order_tested = false;             ///< a small contact swept over most rows
  bool column_order_tested = false;
  std::vector<ArrayFinding> findings = {};
  std::vector<std::optional<SenselFault>> verdicts = {};  ///< of each sensel; unset: may be sound
  /// True if the readings show no force, whatever is done: they are all equal, scaled frame by
  /// frame, cut to two values, or their bytes are swapped.
  [[nodiscard]] bool is_no_force() const;
};

/// Looks at the frames of any pressure array and says what is wrong with it (docs/command_line.md).
///
/// Keeps at most 4096 frames and 32 million readings, 128 MB; of more frames every second, fourth
/// ... one.
class Doctor {
 public:
  /// Messages use `name` as the name of the frames.
  Doctor(std::string name, const Skin& skin, SenselType type);
  ~Doctor();
  Doctor(Doctor&&) noexcept;
  Doctor& operator=(Doctor&&) noexcept;

  /// Adds a frame of the skin's size and type; NaN is a frame without a time.
  void add(const FrameView& frame, double time_s);

  /// Judges the frames so far, once: takes the kept frames. Throws Error for fewer than 10 frames
  /// and for frames of NaN alone.
  [[nodiscard]] Diagnosis result();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
