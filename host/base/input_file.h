#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>

namespace pillarfield {

/// A regular file, open for reading at any offset. Neither opening nor reading it waits for another
/// process, as for a pipe; files without a size, as in /proc, are empty.
class InputFile {
 public:
  /// Throws Error if the file is not a regular file, cannot be opened or has more than
  /// `most_bytes`.
  explicit InputFile(std::filesystem::path path,
                     std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< bytes, when it was opened

  /// Fills `bytes` from `offset` on. Throws Error if the file ends before.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

  /// Up to `count` bytes from `offset` on, fewer at the end of the file.
  [[nodiscard]] std::string text_at(std::uint64_t offset, std::uint64_t count) const;
  [[nodiscard]] std::string text() const { return text_at(0, size_); }  ///< the whole file

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace pillarfield
