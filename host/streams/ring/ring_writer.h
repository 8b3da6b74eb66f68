#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "streams/ring/cut_guard.h"
#include "streams/ring/ring_memory.h"

namespace pillarfield {

/// Writes a ring in shared memory, in one thread. It takes up a ring of the same layout whose
/// writer was killed, replaces another one, and unlinks its own at the end.
class RingWriter {
 public:
  /// `name` without "shm:". Throws Error if the name is not allowed, another program writes the
  /// ring, or memory is short.
  RingWriter(const std::string& name, const RingLayout& layout, std::uint32_t slots);
  ~RingWriter();
  RingWriter(const RingWriter&) = delete;
  RingWriter& operator=(const RingWriter&) = delete;

  /// The slot of the next publication, to be filled from the second member on; publish() must
  /// follow in the same thread.
  [[nodiscard]] std::span<std::byte> begin();

  /// Publishes what was written to begin(); false once another program has shortened the segment:
  /// then no reader sees the ring any more.
  [[nodiscard]] bool publish();

  /// Unlinks the ring; readers see that it is closed.
  void close();

 private:
  [[nodiscard]] bool open();
  void allocate(std::uint64_t bytes);
  [[nodiscard]] PillarfieldRing& ring() const;

  std::string name_;
  std::string segment_name_;
  Descriptor segment_;
  PillarfieldRing layout_ = {};  ///< ours; nobody changes it
  Mapping memory_;
  CutGuard guard_;
  std::uint64_t number_ = 0;  ///< of the next publication
};

}  // namespace pillarfield
