#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace pillarfield {

inline constexpr std::size_t kMostSlots = 64;

/// Numbers of slots, first in, first out. Takes no memory while frames run.
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

/// Slots that were pinned and given back, from any thread. What was read of a slot before
/// give_back() was read before whatever follows the take() that yields it.
class ReturnedSlots {
 public:
  void give_back(std::size_t slot) { bits_.fetch_or(bit(slot), std::memory_order_release); }
  /// By one thread.
  std::optional<std::size_t> take();
  [[nodiscard]] std::size_t size() const;

 private:
  static std::uint64_t bit(std::size_t slot) { return std::uint64_t{1} << slot; }
  std::atomic<std::uint64_t> bits_{0};
};

/// Which slot is whose: free, in flight, last received, or pinned.
///
/// A slot waits for its next frame in the order in which frames were received, so that results stay
/// as long as they can; those given back were read already and come first.
class SlotScheduler {
 public:
  explicit SlotScheduler(std::size_t slots);

  /// A slot for the next frame; none where all are in flight or pinned. Either submit() follows, or
  /// the slot is given back.
  std::optional<std::size_t> next();

  /// Its frame is in flight.
  void submit(std::size_t slot) { in_flight_.push(slot); }

  /// The slot of the oldest frame in flight, of which there must be one.
  [[nodiscard]] std::size_t oldest() const { return in_flight_.front(); }

  /// That frame is received.
  void receive();

  /// Takes the slot last received out of the turns, until returned()->give_back(); none where it is
  /// not there any more.
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
