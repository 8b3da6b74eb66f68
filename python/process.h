#pragma once

#include <unistd.h>

#include <memory>
#include <string>
#include <utility>

#include "pillarfield/processor.h"

namespace pillarfield::python {

/// An object with threads, which only the process that made it may use: a fork has no copy of them.
/// A fork never destroys it either, since that would wait for them.
template <class T>
class ProcessBound {
 public:
  ProcessBound() = default;
  explicit ProcessBound(std::unique_ptr<T> object) : object_(std::move(object)) {}
  ~ProcessBound() { reset(); }
  ProcessBound(ProcessBound&& other) noexcept
      : process_(other.process_), object_(std::move(other.object_)) {}
  ProcessBound& operator=(ProcessBound&&) = delete;
  ProcessBound(const ProcessBound&) = delete;
  ProcessBound& operator=(const ProcessBound&) = delete;

  void reset() {
    if (is_foreign()) {
      static_cast<void>(object_.release());
    } else {
      object_.reset();
    }
  }
  [[nodiscard]] bool is_foreign() const { return getpid() != process_; }
  [[nodiscard]] T* get() const { return object_.get(); }

 private:
  pid_t process_ = getpid();
  std::unique_ptr<T> object_;
};

/// Throws Error: `what` belongs to another process.
[[noreturn]] void throw_foreign(const std::string& what);

/// The device of this name, opened once a process. Throws Error in a fork of a process that opened
/// a device, but for "host".
[[nodiscard]] Device device_named(const std::string& name);

}  // namespace pillarfield::python
