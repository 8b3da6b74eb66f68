#include "viewer/app/source/loading.h"

#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {

Loading::Loading(Options options, double scale, std::function<void()> wake)
    : options_(std::move(options)),
      wake_(std::move(wake)),
      thread_([this, scale] { run(scale); }) {}

Loading::~Loading() {
  stopping_ = true;
  thread_.join();
}

std::string Loading::message() const {
  const std::scoped_lock lock(mutex_);
  return message_;
}

std::optional<LoadedSource> Loading::take() {
  const std::scoped_lock lock(mutex_);
  if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
  return std::exchange(loaded_, std::nullopt);
}

void Loading::run(double scale) {
  try {
    LoadedSource loaded =
        load_source(options_, scale, [this](const std::string& words) { tell(words); });
    const std::scoped_lock lock(mutex_);
    loaded_ = std::move(loaded);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failed_ = std::current_exception();
  }
  wake_();
}

void Loading::tell(const std::string& words) {
  if (stopping_) throw Error(options_.source.string(), "interrupted", "open it again");
  {
    const std::scoped_lock lock(mutex_);
    if (message_ == words) return;
    message_ = words;
  }
  wake_();
}

}  // namespace pillarfield::viewer
