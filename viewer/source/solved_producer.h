#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "pillarfield/frame.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

/// Readings, unchanged while a copy of the handle is alive.
struct FrameHandle {
  std::shared_ptr<const FrameBuffer> readings;
  double time_s = 0;
};

/// Provides frames of readings in any order. Not thread safe.
class FrameProvider {
 public:
  virtual ~FrameProvider() = default;
  [[nodiscard]] virtual std::uint64_t frames() const = 0;

  /// At most FieldProducer::kMostShown handles may be alive. Throws Error where reading fails.
  [[nodiscard]] virtual FrameHandle frame(std::uint64_t index) = 0;

  /// See FieldProducer::refresh().
  virtual bool refresh() { return false; }
};

/// Simulates the first `frames` frames of a scene, with one thread per core. Calls `progress` from
/// this thread about 20 times a second; an exception from it stops the simulation.
[[nodiscard]] std::unique_ptr<FrameProvider> simulate_frames(
    const Simulator& simulator, std::uint64_t frames, const std::function<void(double)>& progress);

/// Reads frames of a file on demand. `source` was opened from `path` with these options.
[[nodiscard]] std::unique_ptr<FrameProvider> recorded_frames(const std::filesystem::path& path,
                                                             std::unique_ptr<FrameSource> source,
                                                             ReadOptions options);

/// The plan extended for display: with angles, and with uncertainty where the noise is known and
/// the estimator supports it; with a fixed baseline.
[[nodiscard]] SolverPlan shown_plan(SolverPlan plan);

/// Fills in the properties that plan and processor determine.
void describe(SourceInfo& info, const SolverPlan& plan, const Processor& processor);

/// Solves the frames of a provider on demand. A field is the processor's pinned result and keeps
/// its readings alive. Where the plan has `memory`, a frame that follows the previous one uses its
/// friction; any other frame is solved alone.
class SolvedProducer final : public FieldProducer {
 public:
  /// `processor` is made for `plan`, with kMostShown slots. Sets the number of frames of `info`.
  SolvedProducer(SourceInfo info, std::shared_ptr<FrameProvider> provider, const SolverPlan& plan,
                 Processor processor);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;
  bool refresh() override;

 private:
  void clear_prior();

  SourceInfo info_;
  std::shared_ptr<FrameProvider> provider_;
  Processor processor_;
  std::optional<double> direct_point_;     ///< of the plan, for the estimator `direct`
  std::optional<FrameBuffer> idle_frame_;  ///< zero readings, where friction is carried over
  std::uint64_t next_ = 0;                 ///< index after the last solved frame
};

}  // namespace pillarfield::viewer
