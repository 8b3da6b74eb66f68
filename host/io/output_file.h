#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace pillarfield {

/// A file open for writing, whose failures are Errors that name it. The caller gathers large
/// blocks.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Writes `text` over what stands at the file's beginning.
  void write_at_begin(std::string_view text);

  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  void close();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace pillarfield
