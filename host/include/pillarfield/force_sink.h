#pragma once

#include <chrono>
#include <cstdint>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// A frame after it was solved. It refers to memory of the solver and of the tracker, which is
/// valid during the call that gets it.
struct SolvedFrame {
  ForceFieldView forces = {};
  const FrameContacts* contacts = nullptr;  ///< null where contacts are not tracked
  double time_s = 0;                        ///< by the clock of the sensor
  std::uint64_t sequence = 0;               ///< its number in the stream that it came from
  std::chrono::nanoseconds arrived{0};      ///< as StreamedFrame::arrived
};

/// Takes solved frames one by one: a file, a socket, a count. See create_force_sink() and
/// create_contact_sink() for files, Pipeline for what calls it.
class ForceSink {
 public:
  ForceSink() = default;
  virtual ~ForceSink() = default;
  ForceSink(const ForceSink&) = delete;
  ForceSink& operator=(const ForceSink&) = delete;

  /// Takes the next frame, forces and contacts at once. Throws Error, and takes nothing of the
  /// frame, where it lacks what the sink writes or has another size.
  virtual void append(const SolvedFrame& frame) = 0;

  /// Completes the output after the last frame. A sink of files that is destroyed before leaves no
  /// file under the final name.
  virtual void finish() {}
};

}  // namespace pillarfield
