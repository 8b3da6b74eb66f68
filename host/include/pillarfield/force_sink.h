#pragma once

#include <chrono>
#include <cstdint>
#include <span>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"

namespace pillarfield {

/// A solved frame. It refers to memory of the solver and the tracker, which is valid only during
/// the call that receives it.
struct SolvedFrame {
  ForceFieldView forces = {};
  const FrameContacts* contacts = nullptr;    ///< null: contacts are not tracked
  FrameView readings = {};                    ///< StreamedFrame::readings; no data: not at hand
  std::span<const SenselBlock> missing = {};  ///< StreamedFrame::missing
  double time_s = 0;                          ///< sensor time
  std::uint64_t sequence = 0;                 ///< StreamedFrame::sequence
  std::chrono::nanoseconds arrived{0};        ///< StreamedFrame::arrived
};

/// Receives solved frames one by one, for instance a file or a socket. create_force_sink() and
/// create_contact_sink() create sinks of files; Pipeline calls a sink.
class ForceSink {
 public:
  ForceSink() = default;
  virtual ~ForceSink() = default;
  ForceSink(const ForceSink&) = delete;
  ForceSink& operator=(const ForceSink&) = delete;

  /// Appends the next frame, with its contacts. Throws Error, and appends nothing, if the frame has
  /// another size or lacks a plane or contacts that the sink writes.
  virtual void append(const SolvedFrame& frame) = 0;

  /// Completes the output after the last frame. A file sink destroyed without finish() leaves no
  /// file under the final name.
  virtual void finish() {}
};

}  // namespace pillarfield
