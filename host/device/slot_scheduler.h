#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace pillarfield {

inline constexpr std::size_t kMostSlots = 64;

/// A FIFO queue of slot indices that does not allocate.
class SlotQueue {
 public:
  void push(std::size_t slot) { slots_.at((first_ + count_++) % kMostSlots) = slot; }
  std::size_t pop() {
    const std::size_t slot = slots_.at(first_);
    first_ = (first_ + 1) % kMostSlots;
    --count_;
    return slot;
  }
  [[nodiscard]] std::size_t front() const { return slots_.at(first_); }
  [[nodiscard]] std::size_t size() const { return count_; }

 private:
  std::array<std::size_t, kMostSlots> slots_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

/// Slots whose pin was released, from any thread. Reads of a slot before give_back() happen before
/// the take() that returns it.
class ReturnedSlots {
 public:
  void give_back(std::size_t slot) { bits_.fetch_or(bit(slot), std::memory_order_release); }
  /// Must be called by one thread only.
  std::optional<std::size_t> take();
  [[nodiscard]] std::size_t size() const;

 private:
  static std::uint64_t bit(std::size_t slot) { return std::uint64_t{1} << slot; }
  std::atomic<std::uint64_t> bits_{0};
};

/// State of each slot: free, in flight, last received, or pinned.
///
/// Returned slots are reused first, then free ones in the order in which their frames were
/// received, so that results stay valid as long as possible.
class SlotScheduler {
 public:
  explicit SlotScheduler(std::size_t slots);

  /// A slot for the next frame; none if all are in flight or pinned. The caller must submit() it or
  /// give it back.
  std::optional<std::size_t> next();

  void submit(std::size_t slot) { in_flight_.push(slot); }

  /// The slot of the oldest frame in flight. Requires one.
  [[nodiscard]] std::size_t oldest() const { return in_flight_.front(); }

  /// Marks the oldest frame in flight as received.
  void receive();

  /// Pins the slot last received until returned()->give_back(); none if it is in use again.
  std::optional<std::size_t> pin();

  [[nodiscard]] std::size_t in_flight() const { return in_flight_.size(); }
  [[nodiscard]] std::size_t pinned() const;
  [[nodiscard]] std::size_t slots() const { return slots_; }
  [[nodiscard]] const std::shared_ptr<ReturnedSlots>& returned() const { return returned_; }

 private:
  std::size_t slots_;
  SlotQueue free_;
  SlotQueue in_flight_;
  std::optional<std::size_t> last_received_;
  std::shared_ptr<ReturnedSlots> returned_;
};

}  // namespace pillarfield
