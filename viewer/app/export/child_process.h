#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pillarfield::viewer {

/// Another program that is fed through its standard input. What it says on standard error is kept,
/// what it says on standard output is not. Destroyed before finish(), it is killed.
class ChildProcess {
 public:
  /// `words`: the program, looked up in PATH, and its arguments. Throws Error where it cannot be
  /// started; `mend` tells what to do where there is no such program.
  ChildProcess(const std::vector<std::string>& words, const std::string& mend);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// False where the program takes no more, which is no signal to this one.
  [[nodiscard]] bool feed(std::span<const std::byte> bytes) const;

  /// Ends its input and waits for its end. True if it ended with status 0.
  [[nodiscard]] bool finish();

  /// Its standard error so far in one line, the last words where it is long.
  [[nodiscard]] std::string complaint() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void close_input();

  std::unique_ptr<std::FILE, Close> errors_;
  int input_ = -1;
  pid_t process_ = -1;
};

}  // namespace pillarfield::viewer
