#include "device/slot_scheduler.h"

#include <bit>
#include <utility>

namespace pillarfield {

std::optional<std::size_t> ReturnedSlots::take() {
  // Mostly there are none, and a load is cheaper than an exchange.
  const std::uint64_t bits = bits_.load(std::memory_order_acquire);
  if (bits == 0) return std::nullopt;
  const auto slot = static_cast<std::size_t>(std::countr_zero(bits));
  bits_.fetch_and(~bit(slot), std::memory_order_acquire);
  return slot;
}

std::size_t ReturnedSlots::size() const {
  return static_cast<std::size_t>(std::popcount(bits_.load(std::memory_order_relaxed)));
}

SlotScheduler::SlotScheduler(std::size_t slots)
    : slots_(slots), returned_(std::make_shared<ReturnedSlots>()) {
  for (std::size_t slot = 0; slot < slots; ++slot) free_.push(slot);
}

std::optional<std::size_t> SlotScheduler::next() {
  if (const auto slot = returned_->take()) return slot;
  if (free_.size() > 0) return free_.pop();
  return std::exchange(last_received_, std::nullopt);
}

void SlotScheduler::receive() {
  if (last_received_) free_.push(*last_received_);
  last_received_ = in_flight_.pop();
}

std::optional<std::size_t> SlotScheduler::pin() {
  return std::exchange(last_received_, std::nullopt);
}

std::size_t SlotScheduler::pinned() const {
  const std::size_t others = free_.size() + in_flight_.size() + (last_received_ ? 1 : 0);
  return slots_ - others - returned_->size();
}

}  // namespace pillarfield
