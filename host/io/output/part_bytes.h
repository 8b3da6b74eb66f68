#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace pillarfield {

/// Writes a part, which is empty at first, and notices if another program shortens or overwrites
/// it, which its lock does not prevent. All functions return 0 or errno, which is ESTALE then.
class PartBytes {
 public:
  explicit PartBytes(int descriptor) : descriptor_(descriptor) {}

  [[nodiscard]] std::uint64_t end() const { return end_; }
  [[nodiscard]] int write(std::span<const std::byte> bytes, std::uint64_t offset);
  [[nodiscard]] int resize(std::uint64_t bytes);

  /// Compares the size and the first bytes with what was written.
  [[nodiscard]] int check() const;

 private:
  int descriptor_;
  std::uint64_t end_ = 0;
  std::array<std::byte, 64> head_{};
};

/// Throws Error about a part with the reason that a function of PartBytes or the system gives.
[[noreturn]] void fail_to_write(const std::filesystem::path& part, int reason);

}  // namespace pillarfield
