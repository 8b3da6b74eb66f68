#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

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

}  // namespace pillarfield::viewer
