#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pillarfield {

/// A program that reads from this one through its standard input. Its standard error is kept. The
/// destructor kills it unless finish() was called.
class ChildProgram {
 public:
  static constexpr int kDiscard = -1;
  static constexpr int kPipe = -2;

  /// `words`: the program, found in PATH, and its arguments. `output`: file descriptor of its
  /// standard output; kDiscard: none; kPipe: read_line(). Throws Error if it cannot be started,
  /// with the remedy `mend` if it is not installed.
  ChildProgram(const std::vector<std::string>& words, const std::string& mend,
               int output = kDiscard);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Writes to the program's standard input. False if the program no longer reads; raises no
  /// signal.
  [[nodiscard]] bool feed(std::span<const std::byte> bytes) const;
  [[nodiscard]] bool feed(const std::string& text) const {
    return feed(std::as_bytes(std::span(text)));
  }

  /// Its next line of output, or the rest if it ends.
  [[nodiscard]] std::string read_line() const;

  /// Closes its input and waits for its end. True if its exit status is 0.
  [[nodiscard]] bool finish();

  /// Its standard error so far.
  [[nodiscard]] std::string errors() const;

  /// Its standard error as one line of at most 400 characters, the last ones.
  [[nodiscard]] std::string error_line() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void close_input();

  std::unique_ptr<std::FILE, Close> errors_;
  int input_ = -1;
  int process_ = -1;  ///< its id
};

}  // namespace pillarfield
