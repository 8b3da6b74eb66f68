#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame_stream.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// A result of a ring.
struct StreamedResult {
  ForceField forces;
  /// The strongest contacts, at most PILLARFIELD_MAX_CONTACTS, without parents, ended contacts and
  /// moments on a surface. Empty where they were not tracked.
  std::optional<FrameContacts> contacts = {};
  std::uint64_t contacts_found = 0;  ///< may be more than `contacts` has
  double time_s = 0;                 ///< sensor time
  std::uint64_t sequence = 0;        ///< of the frame
  std::chrono::nanoseconds arrived{
      0};  ///< of the frame at the program that solved it, steady_clock
};

/// Results that another program writes into the ring `shm:NAME` (`stream --to shm:NAME`,
/// create_live_sink()), for programs that draw them or act on them; used by one thread. Any number
/// of programs read a ring, and none delays its writer.
class ResultStream {
 public:
  ResultStream() = default;
  virtual ~ResultStream() = default;
  ResultStream(const ResultStream&) = delete;
  ResultStream& operator=(const ResultStream&) = delete;

  /// Size, pitch and layout; the other constants are not known.
  [[nodiscard]] virtual const Skin& skin() const = 0;

  /// Waits for the next result, at most for `timeout`; false if none came. The first one is the
  /// newest of the ring; a reader that falls behind goes on with the newest. A ring that replaces
  /// this one is followed if it has the same layout. Does not throw: nothing in the ring is
  /// trusted.
  [[nodiscard]] virtual bool next(StreamedResult& result, std::chrono::nanoseconds timeout) = 0;

  /// `frames`; `lost`, numbers of frames without a result; `restarts`, numbers that went back;
  /// `overrun`, results that were overwritten before they were read; `invalid`, segments that did
  /// not fit; `mismatch`. The others are 0.
  [[nodiscard]] virtual StreamHealth health() const = 0;
};

/// Opens the ring of results `shm:NAME` and waits until there is one. Returns null if it holds
/// frames, or if `stop`, called about ten times a second, returned true. Throws Error for another
/// source, or a ring that cannot be read.
[[nodiscard]] std::unique_ptr<ResultStream> open_result_stream(const std::string& source,
                                                               const std::function<bool()>& stop);

}  // namespace pillarfield
