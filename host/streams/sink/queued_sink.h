#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pillarfield/live.h"
#include "streams/sink/frame_copy.h"

namespace pillarfield {

/// The work of a QueuedSink on each frame.
class SinkConsumer {
 public:
  SinkConsumer() = default;
  virtual ~SinkConsumer() = default;
  SinkConsumer(const SinkConsumer&) = delete;
  SinkConsumer& operator=(const SinkConsumer&) = delete;

  /// The parts of this frame that consume() needs; none: the frame is skipped. Runs in the stream's
  /// thread, beside the functions below, which run in the sink's.
  [[nodiscard]] virtual FrameParts wants(const SolvedFrame& frame) = 0;

  /// Writes or sends a frame. Returns false if the frame is lost, and throws Error if all later
  /// ones will be too.
  [[nodiscard]] virtual bool consume(const SolvedFrame& frame) = 0;

  virtual void report(const HealthReport& health) { static_cast<void>(health); }
  virtual void set_tare(const LiveSinkInfo& info) { static_cast<void>(info); }
  /// Called about ten times a second while no frame arrives.
  virtual void idle() {}
  /// Completes the output after the last frame.
  virtual void finish() {}
  /// Sets `clients` and `refused`, and adds to `dropped`; may run in any thread.
  virtual void add_to(LiveSinkStatistics& statistics) const { static_cast<void>(statistics); }
};

/// Limits of the frames that wait, and of the memory kept for later ones. One frame may always
/// wait, however large.
struct QueueLimits {
  std::size_t frames = 512;
  std::size_t bytes = std::size_t{64} << 20;
};

/// A live sink that runs a consumer in a thread of its own, behind a queue. append() copies the
/// parts of the frame that the consumer wants, and drops the frame if the queue is full. Frames
/// after a failure are dropped too.
class QueuedSink final : public LiveSink {
 public:
  QueuedSink(std::string name, std::unique_ptr<SinkConsumer> consumer,
             const QueueLimits& limits = {});
  /// Consumes the frames that wait, and does not finish.
  ~QueuedSink() override;

  void append(const SolvedFrame& frame) override;
  /// Consumes the frames that wait, and completes the output.
  void finish() override;
  void report(const HealthReport& health) override;
  void set_tare(const LiveSinkInfo& info) override;

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] LiveSinkStatistics statistics() const override;

 private:
  struct Slot {
    FrameCopy copy;
    std::size_t bytes = 0;     // of the frame
    std::size_t capacity = 0;  // of the copy while it is free
  };
  enum class End : std::uint8_t { none, abandoned, finished };

  [[nodiscard]] Slot* take_slot(std::size_t bytes);
  void free_slot(Slot& slot);
  void run();
  void work();
  void consume_oldest(std::unique_lock<std::mutex>& lock);
  void end_thread(End end);
  void fail(const std::string& reason);

  const std::string name_;
  const QueueLimits limits_;
  std::unique_ptr<SinkConsumer> consumer_;
  std::vector<Slot> slots_;

  mutable std::mutex mutex_;  // of the members below
  std::condition_variable changed_;
  std::vector<Slot*> free_;  // the last freed is taken first, so that few hold memory
  std::size_t free_bytes_ = 0;
  std::deque<Slot*> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::optional<HealthReport> health_;
  std::optional<LiveSinkInfo> tare_;
  End end_ = End::none;
  std::uint64_t frames_ = 0;
  std::uint64_t dropped_ = 0;
  std::string failure_;

  std::thread thread_;  // last: it uses the other members
};

}  // namespace pillarfield
