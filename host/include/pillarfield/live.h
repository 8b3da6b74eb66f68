#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/force_file.h"
#include "pillarfield/frame_stream.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// Options of a live source.
struct LiveSourceOptions {
  /// Constants of the skin, in place of those that `skin` or the frames state, and whether readings
  /// fall under load; the options about files must not be set.
  ReadOptions read = {};
  /// The skin of a program, but for rows and columns, which the frames bring. Constants that it
  /// does not state are those of the frames; if neither states the layout, it is one of pillars, of
  /// which `say` warns. Unset: what the frames state, else the defaults and the layout `sensels`.
  std::optional<Skin> skin = {};
  Calibration calibration = {};
  /// The size of the frames, where it is known. `udp:`, to which anyone may send, waits for frames
  /// of this size; with another source, frames of another size are an Error.
  std::optional<FrameSize> size = {};
  /// Called with what its user should know, such as StreamHealth::mismatch while frames of `size`
  /// are waited for.
  std::function<void(const std::string&)> say = {};
  /// Called about ten times a second while no frame has arrived yet; true gives up.
  std::function<bool()> stop = {};
  /// Time after which an Error ends the wait for the first frame; unset: the wait has no end.
  std::optional<std::chrono::nanoseconds> most_wait = {};
  std::uint32_t serial_baud = 2'000'000;  ///< of `serial:`
  /// Only the newest of the frames that wait is delivered: the others are dropped and count in
  /// StreamHealth::lost and overrun. For a program that is slower than its sensor.
  bool newest = false;
};

/// True if `source` names a live source: `-` (packets on standard input), `shm:NAME` (a ring in
/// shared memory), `udp:ADDRESS:PORT`, or `serial:DEVICE` (packets) with
/// `?protocol=flexitac&rows=ROWS&cols=COLS` for a FlexiTac board, and `serial:auto`, which finds
/// one (docs/streams.md); also one misspelt, unless a file has this name: open_live_source() names
/// the right one.
[[nodiscard]] bool is_live_source(std::string_view source);

/// Opens a live source and waits for its first frame, or as many bytes of packets as one has, which
/// gives size and type of the frames; memory for them is allocated then. Its streams follow a
/// sensor that stops and starts again. next() never throws for what a sensor sends: invalid packets
/// are counted in health(). Returns null if LiveSourceOptions::stop gave up. Throws Error if the
/// name is none of a live source, the source cannot be opened (a ring that does not exist yet is
/// waited for), an option is one about files, no frame came in time, or the calibration or the size
/// does not fit the frames.
[[nodiscard]] std::unique_ptr<FrameStream> open_live_source(const std::string& source,
                                                            const LiveSourceOptions& options);

/// Statistics of a live sink so far.
struct LiveSinkStatistics {
  std::uint64_t frames = 0;   ///< written or sent
  std::uint64_t dropped = 0;  ///< frames that the sink was too slow for
  std::uint64_t clients = 0;  ///< connected now
  std::uint64_t refused = 0;  ///< clients refused or disconnected by a limit
  std::string failure = {};   ///< why it stopped; empty while it works
  std::string notice = {};    ///< the first client refused for where it comes from; empty: none
};

/// The state of a live run, about once a second.
struct HealthReport {
  StreamHealth stream = {};
  std::uint64_t solved = 0;      ///< frames since the start
  double latency_ms_median = 0;  ///< from arrival to delivery, over the last second
  double latency_ms_worst = 0;   ///< over the last second
  double since_frame_s = 0;      ///< since the last frame arrived
  std::uint64_t dead = 0;        ///< sensels that do not respond where the others do
  std::uint64_t stuck = 0;       ///< sensels whose reading is constant and out of place
  std::uint64_t drifting = 0;    ///< untouched sensels whose reading left their tare
  std::string coverage = {};     ///< a sentence while contact covers the array
};

struct LiveSinkInfo;

/// A sink that never delays its stream: append() copies what the sink needs, and drops the frame if
/// the sink is behind. It never throws after construction: a sink that fails stops, and
/// statistics() tells why.
class LiveSink : public ForceSink {
 public:
  [[nodiscard]] virtual const std::string& name() const = 0;
  [[nodiscard]] virtual LiveSinkStatistics statistics() const = 0;
  /// Passes the health of the run on, where the sink has a place for it; called between frames.
  virtual void report(const HealthReport& health) { static_cast<void>(health); }
  /// Replaces tare, noise and threshold that a recording states, for all of its frames; other sinks
  /// have none.
  virtual void set_tare(const LiveSinkInfo& info) { static_cast<void>(info); }
};

/// Description of the stream that a live sink passes on.
struct LiveSinkInfo {
  ForceFileInfo forces = {};
  Skin skin = {};
  SenselType sensel_type = SenselType::u8;
  Calibration calibration = {};        ///< for recordings of raw frames
  Replace replace = Replace::results;  ///< which existing file a sink of files may replace
  /// Web pages, such as "https://app.foxglove.dev", that may connect to a server; programs and
  /// pages of this computer always may.
  std::vector<std::string> allowed_origins = {};
};

/// Throws Error unless a target is one of create_live_sink(), with a valid address; opens nothing.
void check_live_sink(const std::string& target);
/// The same of create_live_relay().
void check_live_relay(const std::string& target);

/// Creates a live sink: `shm:NAME` (a ring of results in shared memory), `udp:ADDRESS:PORT` (JSON
/// of contacts and total), `foxglove:[ADDRESS:]PORT` (a WebSocket server), `web:[ADDRESS:]PORT`
/// (a page in the browser; the name of the sink is its URL), a .mcap file, or any
/// file of create_force_sink() (docs/streams.md). Throws Error for another target, or one that
/// cannot be opened.
[[nodiscard]] std::unique_ptr<LiveSink> create_live_sink(const std::string& target,
                                                         const LiveSinkInfo& info);

/// A live sink that writes the raw frames, once they are solved, into the ring `shm:NAME`, which
/// any number of programs open as a live source. Frames with readings missing are left out. Throws
/// Error for another target, or a ring that cannot be written.
[[nodiscard]] std::unique_ptr<LiveSink> create_live_relay(const std::string& target,
                                                          const LiveSinkInfo& info);

/// A live sink that records the raw frames, as RecordingWriter does, and survives a kill.
[[nodiscard]] std::unique_ptr<LiveSink> create_live_recording(const std::string& path,
                                                              const LiveSinkInfo& info);

}  // namespace pillarfield
