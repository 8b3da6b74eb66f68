#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pillarfield {

/// Another program that is fed through its standard input. What it says on standard error is kept.
/// Destroyed before finish(), it is killed.
class ChildProgram {
 public:
  static constexpr int kDiscard = -1;
  static constexpr int kAnswer = -2;

  /// `words`: the program, looked up in PATH, and its arguments. `output` is the file descriptor
  /// that its standard output is; kDiscard: none; kAnswer: read_line(). Throws Error where it
  /// cannot be started; `mend` tells what to do where there is no such program.
  ChildProgram(const std::vector<std::string>& words, const std::string& mend,
               int output = kDiscard);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// False where the program takes no more, which is no signal to this one.
  [[nodiscard]] bool feed(std::span<const std::byte> bytes) const;
  [[nodiscard]] bool feed(const std::string& text) const {
    return feed(std::as_bytes(std::span(text)));
  }

  /// What it says next, to the end of the line or of the program.
  [[nodiscard]] std::string read_line() const;

  /// Ends its input and waits for its end. True if it ended with status 0.
  [[nodiscard]] bool finish();

  /// Its standard error so far.
  [[nodiscard]] std::string errors() const;

  /// The same in one line, the last words where it is long.
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

}  // namespace pillarfield
