#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "viewer/source/curves.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

/// Measures the curves of all frames of a source in a thread of its own, beside the display.
class Survey {
 public:
  /// `open` makes a producer of its own for the survey; it runs in the thread.
  Survey(std::function<std::unique_ptr<FieldProducer>()> open, std::shared_ptr<Curves> curves);
  ~Survey();  ///< waits for the frame in work
  Survey(const Survey&) = delete;
  Survey& operator=(const Survey&) = delete;

  /// Works at most half of the time, for a display that plays.
  void set_busy(bool busy) { busy_ = busy; }
  /// Looks for new frames ten times a second.
  void set_follow(bool follow) { follows_ = follow; }

  struct Progress {
    std::uint64_t done = 0;    ///< frames measured
    std::uint64_t frames = 0;  ///< of the source
    std::string failure;       ///< why the survey ended early
  };
  [[nodiscard]] Progress progress() const;

  /// Calls `wake` from the thread about ten times a second while the survey proceeds. The previous
  /// one is not called after return.
  void on_progress(std::function<void()> wake);

 private:
  void run();
  void measure_all(FieldProducer& producer);
  void rest(FieldProducer& producer);
  void set_frames(std::uint64_t frames);
  void tell(bool at_once);

  std::function<std::unique_ptr<FieldProducer>()> open_;
  std::shared_ptr<Curves> curves_;
  std::atomic<bool> busy_ = false;
  std::atomic<bool> follows_ = false;
  std::atomic<bool> stopping_ = false;
  std::chrono::steady_clock::time_point told_;

  mutable std::mutex mutex_;  ///< guards the next three members
  std::condition_variable changed_;
  std::uint64_t frames_ = 0;
  std::string failure_;

  std::mutex waking_;  ///< guards `wake_`, also while it runs
  std::function<void()> wake_;
  std::thread thread_;  ///< last: uses the other members
};

}  // namespace pillarfield::viewer
