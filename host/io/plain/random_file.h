#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace pillarfield {

/// A file that is read at any offset.
class RandomFile {
 public:
  /// Throws Error if the file cannot be opened.
  explicit RandomFile(std::filesystem::path path);
  ~RandomFile();
  RandomFile(RandomFile&& other) noexcept;
  RandomFile& operator=(RandomFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< bytes, when it was opened

  /// Fills `bytes` from `offset` on. Throws Error if the file ends before.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

  /// Up to `count` bytes from `offset` on, fewer at the end of the file.
  [[nodiscard]] std::string text_at(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace pillarfield
