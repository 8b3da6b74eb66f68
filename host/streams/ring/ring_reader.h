#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "streams/ring/ring_memory.h"

namespace pillarfield {

/// Reads a ring in shared memory, and the one that replaces it. Trusts nothing in the segment:
/// copies it with pread(), which a segment that shrinks cannot crash.
class RingReader {
 public:
  using Time = std::chrono::nanoseconds;

  /// The content that the reader accepts.
  enum class Content : std::uint8_t { any, frames, results };

  /// `name` without "shm:". The ring need not exist yet. Throws Error if the name is not allowed.
  RingReader(const std::string& name, Content content);

  /// Opens the ring if it exists; whether it is open. Throws Error if the segment has none of this
  /// content, belongs to another user than this one or root, or may not be read.
  bool open();

  /// The layout of the first ring; later ones must have it too. Set once the ring was open.
  [[nodiscard]] const std::optional<RingLayout>& layout() const { return layout_; }

  /// Waits for the next publication and copies its slot. The first one is the newest of the ring;
  /// a reader that fell behind goes on with the newest. Null after the timeout. Throws as open()
  /// if no ring was open before; otherwise waits for one that fits.
  const std::byte* read(Time timeout);

  /// Publications that were overwritten before they were read.
  [[nodiscard]] std::uint64_t overrun() const { return overrun_; }
  /// Segments that did not fit.
  [[nodiscard]] std::uint64_t invalid() const { return invalid_; }
  /// The layout of the latest ring of this content that did not fit.
  [[nodiscard]] const std::optional<RingLayout>& other() const { return other_; }

 private:
  [[nodiscard]] bool attach();
  [[nodiscard]] bool fits(const PillarfieldRing& ring, std::uint64_t bytes);
  [[nodiscard]] bool is_wanted(const RingLayout& layout) const;
  void detach();
  bool is_replaced() const;
  void detach_if_replaced();
  template <class T>
  T load(std::size_t offset) const;
  bool copy_next();
  void skip_to(std::uint64_t number);
  void wait(std::uint32_t signal, Time timeout);

  std::string name_;
  std::string segment_name_;
  Content content_;
  Descriptor segment_;
  Mapping head_;  ///< for the address of the futex; never read
  PillarfieldRing ring_ = {};
  std::uint64_t rejected_inode_ = 0;
  Time checked_{0};  ///< when a replacement was last looked for
  std::optional<RingLayout> layout_;
  std::optional<RingLayout> other_;
  std::vector<std::byte> slot_;
  std::uint64_t next_ = 0;
  std::uint64_t overrun_ = 0;
  std::uint64_t invalid_ = 0;
};

}  // namespace pillarfield
