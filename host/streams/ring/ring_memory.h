#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "pillarfield/pitch.h"
#include "pillarfield/stream_format.h"

namespace pillarfield {

/// The content of a ring.
struct RingLayout {
  std::uint32_t kind = PILLARFIELD_RING_FRAMES;  ///< PillarfieldRingKind; a foreign ring has any
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::uint32_t type = 0;  ///< PillarfieldReadingType of frames
  Pitch pitch_mm = {};     ///< of the elements of results

  bool operator==(const RingLayout&) const = default;
};

/// Results of pillars or of sensels, rather than frames.
[[nodiscard]] bool holds_results(const RingLayout& layout);

/// Bytes of a slot that a layout needs; none if it is out of range.
[[nodiscard]] std::optional<std::uint64_t> content_bytes(const RingLayout& layout);

/// As many slots as take up to 64 MiB, 4 to 64.
[[nodiscard]] std::uint32_t slots_for(const RingLayout& layout);

[[nodiscard]] RingLayout layout_of(const PillarfieldRing& ring);

/// True if the slots of a ring hold its layout and lie in a segment of `segment_bytes`.
[[nodiscard]] bool is_valid(const PillarfieldRing& ring, std::uint64_t segment_bytes);

/// Offset of a publication's slot in the segment.
[[nodiscard]] std::uint64_t slot_offset(const PillarfieldRing& ring, std::uint64_t number);

/// The name for shm_open() of the ring `shm:NAME`. Throws Error unless NAME is 1 to 200 letters,
/// digits, '.', '_' or '-'.
[[nodiscard]] std::string segment_name(const std::string& name);

/// A file descriptor, closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
  }
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  void reset();

 private:
  int descriptor_ = -1;
};

/// The first bytes of a segment in memory, unmapped at the end.
class Mapping {
 public:
  Mapping() = default;
  /// Without memory if the mapping fails.
  Mapping(const Descriptor& segment, std::uint64_t bytes, bool writable);
  ~Mapping();
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  [[nodiscard]] std::byte* data() const { return data_; }

 private:
  std::byte* data_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// Waits until the word is no longer `value`, a waker wakes, or the timeout passes.
void wait_for_word(const std::byte* word, std::uint32_t value, std::chrono::nanoseconds timeout);

/// Wakes all who wait for the word.
void wake_waiting(std::byte* word);

}  // namespace pillarfield
