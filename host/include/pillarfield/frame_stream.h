#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "pillarfield/calibration.h"
#include "pillarfield/frame.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// A place for one frame of a stream, and the frame in it.
struct StreamedFrame {
  StreamedFrame(SenselType type, const Skin& skin) : buffer(type, skin.rows, skin.cols) {}

  FrameBuffer buffer;  ///< for streams that write or copy their readings
  FrameView readings;  ///< the frame: in `buffer`, or in memory of the stream
  double time_s = 0;   ///< when the sensor took it, by the sensor's clock
  /// Which frame it is, as the sensor counts them; a gap means that frames were lost.
  std::uint64_t sequence = 0;
  std::chrono::nanoseconds arrived{0};  ///< when it reached this computer, by std::steady_clock
};

/// What next() found.
enum class Arrival : std::uint8_t {
  arrived,    ///< a frame
  timed_out,  ///< none yet
  ended,      ///< none, and none will come
};

/// Frames that arrive one after another. Their number is not known beforehand. For frames of a file
/// in any order see FrameSource. For one thread.
class FrameStream {
 public:
  FrameStream() = default;
  virtual ~FrameStream() = default;
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  [[nodiscard]] virtual const Skin& skin() const = 0;
  [[nodiscard]] virtual SenselType sensel_type() const = 0;

  /// What the stream knows of its sensels; empty unless overridden.
  [[nodiscard]] virtual const Calibration& calibration() const;

  /// Waits for the next frame, for `timeout` at most; it may give up earlier. Zero only looks.
  ///
  /// Sets all members of `frame`. Where `readings` is not in `frame.buffer`, the memory must stay
  /// as it is until `frame` is given to next() again: the device reads it meanwhile. Without a
  /// frame, `sequence` may be set to the number of the frame that comes next, which tells of lost
  /// ones. Throws Error, its place being the stream, where the stream fails.
  [[nodiscard]] virtual Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) = 0;
};

/// The frames of a file, each as soon as it is asked for. `source` must outlive the stream.
[[nodiscard]] std::unique_ptr<FrameStream> file_stream(FrameSource& source);

/// When the frames of a paced stream come.
struct Pace {
  std::optional<double> rate_hz = {};  ///< above 0; unset: as StreamedFrame::time_s says
  /// A frame that is not taken within this time is dropped; unset: none is.
  std::optional<std::chrono::nanoseconds> drop_after = {};
  std::chrono::nanoseconds spin{0};  ///< of each wait, how much at its end is spent spinning
};

/// Lets the frames of a stream come at a pace, as from a sensor: the first at once, the others when
/// they are due, or as soon as they are asked for where that is later. `arrived` is when a frame
/// was due. At a rate, the stream ends one period after its last frame. Throws Error on a rate that
/// is not above 0.
[[nodiscard]] std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream,
                                                        const Pace& pace);

}  // namespace pillarfield
