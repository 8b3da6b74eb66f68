#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_file.h"

namespace pillarfield {

/// Reads a text file line by line in constant memory. Lines end with LF or CRLF.
class LineReader {
 public:
  /// `mend_long` is the remedy for a line that is too long. Throws Error if the file cannot be
  /// opened.
  explicit LineReader(std::filesystem::path path, const char* mend_long = "");

  /// Moves to the next line; false at the end. Throws Error if a line exceeds 1 MiB.
  bool next();

  /// The line without its end, valid until next().
  [[nodiscard]] std::string_view line() const { return line_; }

  /// Number of the line, from 1 on.
  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  /// "file:line", for messages.
  [[nodiscard]] std::string place() const;

 private:
  void fill();

  InputFile file_;
  std::uint64_t offset_ = 0;  // of the next bytes for the buffer
  const char* mend_long_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // of the unread bytes
  std::size_t end_ = 0;
  std::string_view line_;
  std::uint64_t number_ = 0;
};

}  // namespace pillarfield
