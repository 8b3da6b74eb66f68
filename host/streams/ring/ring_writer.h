#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "streams/ring/ring_memory.h"

namespace pillarfield {

/// Lets a thread survive that another program shortens the shared memory which it writes, instead
/// of SIGBUS, which ends the process: the memory is replaced by private memory at its first access
/// beyond the new end. Signals of other memory go to the handler that was there before.
class CutGuard {
 public:
  /// Installs the handler of the process.
  CutGuard();
  ~CutGuard() { end(); }
  CutGuard(const CutGuard&) = delete;
  CutGuard& operator=(const CutGuard&) = delete;

  /// The mapped memory; not between begin() and end() of another guard of this thread.
  void watch(std::span<std::byte> memory) { memory_ = memory; }

  /// From begin() to end() this thread may access the memory.
  void begin();
  void end();

  /// True if the memory was replaced.
  [[nodiscard]] bool is_cut() const { return is_cut_ != 0; }

 private:
  static void on_bus_error(int signal, siginfo_t* info, void* context);
  bool replace(const void* accessed);

  std::span<std::byte> memory_;
  volatile std::sig_atomic_t is_cut_ = 0;
};

/// Writes a ring in shared memory, in one thread. It takes up a ring of the same layout whose
/// writer was killed, replaces another ring, and unlinks its own at the end.
class RingWriter {
 public:
  /// `name` without "shm:". Throws Error if the name is not allowed, another program writes the
  /// ring, the shared memory of this name is not a ring, or memory is short.
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
  [[nodiscard]] bool holds_ring(std::uint64_t bytes) const;
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
