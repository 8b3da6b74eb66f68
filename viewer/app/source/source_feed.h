#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "viewer/app/app_state.h"
#include "viewer/app/load_range.h"
#include "viewer/app/source/loaded_source.h"

namespace pillarfield::viewer {

/// Opens a source in a thread of its own, so that the window shows how far it is.
class Loading {
 public:
  /// `wake` is called from the thread for each message and at the end.
  Loading(Options options, double scale, std::function<void()> wake);
  ~Loading();  ///< stops, and waits for the thread
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] std::string message() const;

  /// The source once it is ready, then nothing. Throws what ended the thread.
  [[nodiscard]] std::optional<LoadedSource> take();

 private:
  void run(double scale);
  void tell(const std::string& words);

  Options options_;
  std::function<void()> wake_;
  std::atomic<bool> stopping_ = false;
  mutable std::mutex mutex_;  ///< guards the next three members
  std::string message_;
  std::optional<LoadedSource> loaded_;
  std::exception_ptr failed_;
  std::thread thread_;  ///< last: uses the other members
};

/// Lets the ranges of a sensor follow its load until the user sets one.
class LoadFollower {
 public:
  explicit LoadFollower(bool follows = false) : follows_(follows) {}

  /// Takes the field on display.
  void take_field(AppState& state);
  /// Forgets the load of frames that arrived until now, which had another tare.
  void forget();

 private:
  bool follows_;
  LoadRange load_;
  std::chrono::nanoseconds since_{};  ///< arrival of the frames that count
  std::optional<Quantity> quantity_;  ///< shown when the range was last as it followed
  Range range_;
};

/// Opens sources in the background, and brings their newest fields into the state.
class SourceFeed {
 public:
  /// `wake` ends the window's wait; it is called in any thread.
  SourceFeed(AppState& state, void (*wake)()) : state_(&state), wake_(wake) {}

  /// Begins to open the source of the options.
  void open(const Options& options, double scale);
  void give_up() { loading_.reset(); }
  /// The source that is being opened; null: none.
  [[nodiscard]] const Loading* loading() const { return loading_.get(); }
  /// The source, once it is open. Throws Error where that fails.
  [[nodiscard]] std::optional<LoadedSource> take_loaded();

  /// Begins with the source of the state: listens to it, and plays it as the options say.
  void begin(const Options& options);
  /// Ends with it; releases the memory of its fields before their players.
  void end();

  /// True if a thread has progressed.
  [[nodiscard]] bool take_news() { return news_.exchange(false); }
  /// Takes what is new: fields and messages of a sensor. True if there was something.
  [[nodiscard]] bool take_fields();

  // News since drawn().
  [[nodiscard]] bool has_field() const { return field_is_new_; }
  /// Time since the new field arrived at a sensor, else since it was solved; none without.
  [[nodiscard]] std::optional<double> latency_ms() const;
  void drawn() { field_is_new_ = false; }

 private:
  void tell();
  void attend_survey();
  bool attend_sensor();
  bool take_field();

  AppState* state_;
  void (*wake_)();
  std::atomic<bool> news_ = false;      ///< a thread has progressed
  std::atomic<double> produced_s_ = 0;  ///< time of the newest field, set by the player's thread
  double taken_s_ = 0;                  ///< that of the field on display
  bool field_is_new_ = false;
  std::uint64_t live_messages_ = 0;
  std::uint64_t live_tares_ = 0;
  LoadFollower load_follower_;
  std::unique_ptr<Loading> loading_;  ///< last: its thread uses other members
};

}  // namespace pillarfield::viewer
