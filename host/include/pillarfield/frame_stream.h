#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// A buffer for one frame of a stream, and that frame.
struct StreamedFrame {
  StreamedFrame(SenselType type, const Skin& skin) : buffer(type, skin.rows, skin.cols) {}
  explicit StreamedFrame(FrameBuffer memory) : buffer(std::move(memory)) {}

  FrameBuffer buffer;  ///< for streams that copy their readings
  FrameView readings;  ///< view of `buffer` or of the stream's memory
  /// Readings that did not arrive; `readings` has earlier ones there. Their pillars are reported as
  /// missing.
  std::vector<SenselBlock> missing;
  double time_s = 0;  ///< sensor time
  /// Frame number of the sensor; a gap means lost frames.
  std::uint64_t sequence = 0;
  std::chrono::nanoseconds arrived{0};  ///< time of arrival, std::steady_clock
};

/// Statistics of a stream so far: frames and packets received, lost and refused.
struct StreamHealth {
  std::uint64_t frames = 0;       ///< delivered by next()
  std::uint64_t lost = 0;         ///< frames whose sequence number never came
  std::uint64_t incomplete = 0;   ///< delivered frames with missing readings
  std::uint64_t late = 0;         ///< packets that came after their frame was delivered or lost
  std::uint64_t duplicates = 0;   ///< packets that came twice
  std::uint64_t reordered = 0;    ///< packets that came after one of a later frame, in time
  std::uint64_t invalid = 0;      ///< packets that are not a frame of this stream
  std::uint64_t restarts = 0;     ///< new sessions, or sequences that started again
  std::uint64_t clock_jumps = 0;  ///< sensor times that went back, or ahead by over a second
  std::uint64_t overrun = 0;      ///< packets or ring slots that came faster than they were read
  double rate_hz = 0;             ///< frames per second, over about the last second
  /// Description of other frames that came instead: "frames are 32 x 32, 40 x 60 expected", rows
  /// and columns of sensels; empty: none.
  std::string mismatch = {};
};

/// Result of FrameStream::next().
enum class Arrival : std::uint8_t {
  arrived,    ///< a frame has arrived
  timed_out,  ///< no frame yet
  ended,      ///< no frame, and none will follow
};

/// A sequence of frames of unknown length, used by one thread. FrameSource gives random access to
/// the frames of a file.
class FrameStream {
 public:
  FrameStream() = default;
  virtual ~FrameStream() = default;
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  [[nodiscard]] virtual const Skin& skin() const = 0;
  [[nodiscard]] virtual SenselType sensel_type() const = 0;

  /// The calibration of the stream's sensels; empty unless overridden.
  [[nodiscard]] virtual const Calibration& calibration() const;

  /// Counts since the stream was opened; zero unless overridden.
  [[nodiscard]] virtual StreamHealth health() const;

  /// Waits for the next frame, at most for `timeout`; may return earlier. A `timeout` of zero
  /// polls.
  ///
  /// Sets all members of `frame`. If `readings` is not in `frame.buffer`, the device reads the
  /// stream's memory, which must not change until next() receives `frame` again. Without a frame,
  /// next() may set `sequence` to the number of the following frame, which shows losses. Throws
  /// Error, naming the stream, if the stream fails.
  [[nodiscard]] virtual Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) = 0;
};

/// Streams the frames of a file from `first` to before `end`, or its last one, each on request.
/// `source` must outlive the stream.
[[nodiscard]] std::unique_ptr<FrameStream> file_stream(
    FrameSource& source, std::uint64_t first = 0,
    std::uint64_t end = std::numeric_limits<std::uint64_t>::max());

/// Timing of a paced stream.
struct Pace {
  std::optional<double> rate_hz = {};  ///< above 0; unset: follow StreamedFrame::time_s
  /// A frame that is not read within this time is dropped, and counts in StreamHealth::lost and
  /// overrun; unset: none is.
  std::optional<std::chrono::nanoseconds> drop_after = {};
};

/// Delivers the frames of a stream at the pace of a sensor: the first at once, each other one when
/// it is due or, if later, on request. `arrived` is the time at which the frame was due. With a
/// rate, the stream ends one period after its last frame. Throws Error if the rate is not above 0.
[[nodiscard]] std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream,
                                                        const Pace& pace);

}  // namespace pillarfield
