#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/solver_plan.h"
#include "pillarfield/tare.h"

namespace pillarfield {

class WireCorrection;

/// Measures tare, noise and threshold of an untouched skin while frames arrive, as take_tare()
/// does.
///
///     LiveTare tare(plan);
///     tare.start(std::chrono::milliseconds(500));
///     if (const SolverPlan* found = tare.add(frame, arrived)) processor.set_plan(*found);
class LiveTare {
 public:
  /// The plan of the frames. `keeps_threshold`: the user stated its threshold.
  explicit LiveTare(SolverPlan plan, bool keeps_threshold = false);
  ~LiveTare();
  LiveTare(const LiveTare&) = delete;
  LiveTare& operator=(const LiveTare&) = delete;

  /// Begins with the next frame; forgets frames added so far. `preloaded` accepts what reads as if
  /// it were touched (TareOptions). `before`: the tare as it is now, where it follows drift; empty:
  /// that of the plan.
  void start(std::chrono::nanoseconds duration, bool preloaded = false,
             std::vector<float> before = {});

  /// True if start() was called and add() has not returned a plan since.
  [[nodiscard]] bool is_running() const { return statistics_.has_value(); }

  /// Adds a frame of the skin's size and type that arrived at `arrived`. Uses at most 50 of them,
  /// at 5 ns a sensel without crosstalk of wires. At the end of the duration, and after at least
  /// kLeastTareFrames, returns the plan with tare, noise, mask of faulty sensels and threshold,
  /// valid until the next start(); null before. Throws Error, and stops, if something touches the
  /// skin: where there is a tare, if sensels read more over it than noise and drift explain.
  const SolverPlan* add(const FrameView& frame, std::chrono::nanoseconds arrived);

  /// Stops without a tare.
  void stop() { statistics_.reset(); }

  /// A sentence on the tare found last: threshold, sensels masked as faulty, and how light a touch
  /// it may have taken in.
  [[nodiscard]] const std::string& note() const { return note_; }

 private:
  const SolverPlan& finish();

  const SolverPlan given_;
  const bool keeps_threshold_;
  SolverPlan found_;
  std::vector<float> before_;
  std::chrono::nanoseconds duration_{0};
  bool preloaded_ = false;
  std::optional<double> threshold_;  ///< of the tare before, counts
  std::optional<TareFrames> statistics_;
  std::optional<std::chrono::nanoseconds> first_;
  std::chrono::nanoseconds next_{0};
  std::unique_ptr<WireCorrection> correct_;
  std::string note_;
};

}  // namespace pillarfield
