// Results that are pinned out of the ring while others are solved.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <thread>

#include "device/slot_scheduler.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "random_plan.h"
#include "same_bits.h"
#include "tests/base/message.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

void expect_solved(const ForceFieldView& forces, const SolverPlan& plan, const RandomFrame& frame) {
  expect_same_bits(forces, solve_on_host(plan, frame.view()).view());
}

template <class Value>
void expect_within(std::span<const std::byte> pages, std::span<const Value> plane) {
  const std::span<const std::byte> bytes = std::as_bytes(plane);
  EXPECT_GE(bytes.data(), pages.data());
  EXPECT_LE(bytes.data() + bytes.size(), pages.data() + pages.size());
}

class PinnedFrames : public OnDevice<Memory> {
 protected:
  [[nodiscard]] static Processor processor(const SolverPlan& plan, int slots) {
    return {test_device(), plan, {.memory = GetParam(), .frames_in_flight = slots}};
  }
};

INSTANTIATE_TEST_SUITE_P(Memories, PinnedFrames, testing::Values(Memory::shared, Memory::staged),
                         [](const testing::TestParamInfo<Memory>& memory) {
                           return memory.param == Memory::shared ? "shared" : "staged";
                         });

std::vector<RandomFrame> frames_of(const SolverPlan& plan, std::uint32_t count) {
  std::vector<RandomFrame> frames;
  for (std::uint32_t seed = 0; seed < count; ++seed) frames.emplace_back(plan, 0, seed);
  return frames;
}

TEST_P(PinnedFrames, StayAsTheyAreWhileOthersAreSolved) {
  const SolverPlan plan = bare_plan(64, 90, SenselType::u8);
  Processor ring = processor(plan, 3);
  const std::vector<RandomFrame> frames = frames_of(plan, 20);
  ring.submit(frames[0].view());
  const ForceFieldView kept_forces = ring.receive();
  const Processor::PinnedResult pinned = ring.pin();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    ring.submit(frames[i].view());
    const ForceFieldView forces = ring.receive();
    expect_solved(forces, plan, frames[i]);
    EXPECT_NE(forces.normal.data(), kept_forces.normal.data());
  }
  expect_solved(kept_forces, plan, frames[0]);
}

TEST_P(PinnedFrames, PagesAreWholeAndHoldEveryPlane) {
  SolverPlan plan = full_plan(34, 46, SenselType::u8, 3);
  plan.angles = true;
  plan.uncertainty = true;
  Processor ring = processor(plan, 2);
  const RandomFrame frame(plan, 0, 1);
  ring.submit(frame.view());
  const ForceFieldView forces = ring.receive();
  const Processor::PinnedResult pinned = ring.pin();
  const std::span<const std::byte> pages = pinned.pages();
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pages.data()) % 4096, 0U);
  EXPECT_EQ(pages.size() % 4096, 0U);
  EXPECT_LE(pages.size(), (3 + 3 + kUncertaintyPlanes + 1) * 5000) << "small planes, a page each";
  std::set<std::uintptr_t> offsets;  // in a page, which picks the set of a cache
  const auto expect_plane = [&](std::span<const float> plane) {
    expect_within(pages, plane);
    const auto address = reinterpret_cast<std::uintptr_t>(plane.data());
    EXPECT_EQ(address % 256, 0U);
    EXPECT_TRUE(offsets.insert(address % 4096).second);
  };
  for (const auto plane : {forces.shear_x, forces.shear_y, forces.normal, forces.magnitude,
                           forces.theta, forces.phi}) {
    expect_plane(plane);
  }
  for (const auto plane : forces.uncertainty) expect_plane(plane);
  expect_within(pages, forces.status);
}

TEST_P(PinnedFrames, GivingBackFreesTheSlot) {
  const SolverPlan plan = bare_plan(16, 16, SenselType::u8);
  Processor ring = processor(plan, 2);
  const std::vector<RandomFrame> frames = frames_of(plan, 8);
  for (const RandomFrame& frame : frames) {
    ring.submit(frame.view());
    expect_solved(ring.receive(), plan, frame);
    const Processor::PinnedResult first = ring.pin();
    ring.submit(frame.view());
    expect_solved(ring.receive(), plan, frame);
    const Processor::PinnedResult second = ring.pin();
    EXPECT_EQ(ring.pinned(), 2);
    EXPECT_NE(first.pages().data(), second.pages().data());
  }
  EXPECT_EQ(ring.pinned(), 0);
}

TEST_P(PinnedFrames, ExhaustionIsOneClearLineAndRecoverable) {
  const SolverPlan plan = bare_plan(16, 16, SenselType::u8);
  Processor ring = processor(plan, 2);
  const std::vector<RandomFrame> frames = frames_of(plan, 2);
  ring.submit(frames[0].view());
  const ForceFieldView forces = ring.receive();
  ASSERT_FALSE(forces.normal.empty());
  std::optional<Processor::PinnedResult> pinned = ring.pin();
  ring.submit(frames[1].view());
  const std::string text = core_test::message_of([&] { ring.submit(frames[1].view()); });
  EXPECT_NE(text.find("of 2 frames 1 are in flight and 1 are pinned"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(ring.in_flight(), 1);
  expect_solved(forces, plan, frames[0]);
  pinned.reset();
  ring.submit(frames[0].view());
  expect_solved(ring.receive(), plan, frames[1]);
  expect_solved(ring.receive(), plan, frames[0]);
}

TEST_P(PinnedFrames, IdleBlocksOfASlotKeepTheirResults) {
  const SolverPlan plan = bare_plan(32, 64, SenselType::u8);
  Processor ring = processor(plan, 3);
  FrameBuffer idle(SenselType::u8, 32, 64);
  const RandomFrame active(plan, 0, 5);
  std::mt19937 random(7);
  std::deque<Processor::PinnedResult> pinned;
  std::deque<std::pair<ForceFieldView, bool>> seen;
  for (int i = 0; i < 60; ++i) {
    const bool is_active = random() % 2 == 0;
    ring.submit(is_active ? active.view() : idle.view());
    const ForceFieldView forces = ring.receive();
    EXPECT_EQ(std::ranges::count(forces.status, 0) == std::ssize(forces.status), !is_active);
    if (is_active) expect_solved(forces, plan, active);
    seen.emplace_back(forces, is_active);
    pinned.push_back(ring.pin());
    const auto stays = static_cast<std::size_t>(random() % 3);
    for (; pinned.size() > stays; pinned.pop_front(), seen.pop_front()) {
      const auto& [then, was_loud] = seen.front();
      EXPECT_EQ(std::ranges::count(then.status, 0) == std::ssize(then.status), !was_loud);
    }
  }
}

TEST_P(PinnedFrames, OutliveTheProcessor) {
  const SolverPlan plan = bare_plan(64, 64, SenselType::u8);
  const RandomFrame frame(plan, 0, 4);
  const RandomFrame other(plan, 0, 5);
  std::optional<Processor::PinnedResult> pinned;
  ForceFieldView forces;
  {
    Processor ring = processor(plan, 2);
    ring.submit(frame.view());
    forces = ring.receive();
    pinned = ring.pin();
    ring.submit(other.view());  // In flight when the processor goes.
  }
  expect_solved(forces, plan, frame);
  std::jthread([&] { pinned.reset(); }).join();
}

TEST_P(PinnedFrames, AreGivenBackFromAnotherThreadWhileFramesAreSolved) {
  const SolverPlan plan = bare_plan(32, 32, SenselType::u8);
  Processor ring = processor(plan, 4);
  const std::vector<RandomFrame> frames = frames_of(plan, 4);
  std::vector<ForceField> expected;
  expected.reserve(frames.size());
  for (const RandomFrame& frame : frames) expected.push_back(solve_on_host(plan, frame.view()));
  struct Shown {
    Processor::PinnedResult pinned;
    ForceFieldView forces;
    std::size_t frame;
  };
  std::mutex mutex;
  std::optional<Shown> waiting;
  std::atomic<int> wrong = 0;
  std::jthread display([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::unique_lock lock(mutex);
      const std::optional<Shown> shown = std::exchange(waiting, std::nullopt);
      lock.unlock();
      if (!shown) continue;
      if (!std::ranges::equal(shown->forces.normal, expected[shown->frame].normal)) ++wrong;
    }
  });
  for (std::size_t i = 0; i < 2000; ++i) {
    const std::size_t frame = i % frames.size();
    ring.submit(frames[frame].view());
    const ForceFieldView forces = ring.receive();
    std::optional<Shown> next;
    next.emplace(Shown{ring.pin(), forces, frame});
    const std::scoped_lock lock(mutex);
    std::swap(waiting, next);
  }
  display.request_stop();
  display.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(PinnedFrames, OnlyTheLastReceivedCanBePinned) {
  const SolverPlan plan = bare_plan(8, 8, SenselType::u8);
  Processor ring = processor(plan, 2);
  const RandomFrame frame(plan, 0, 1);
  EXPECT_THROW(static_cast<void>(ring.pin()), Error) << "nothing was received";
  ring.submit(frame.view());
  EXPECT_THROW(static_cast<void>(ring.pin()), Error) << "it is in flight";
  static_cast<void>(ring.receive());
  ring.submit(frame.view());
  const Processor::PinnedResult pinned = ring.pin();  // Its slot was not used since.
  EXPECT_THROW(static_cast<void>(ring.pin()), Error) << "it is pinned already";
}

/// The lifetime of results that are not pinned.
TEST(SlotScheduler, ASlotIsUsedAgainAfterAsManyFramesAsAreNotPinned) {
  for (std::size_t slots = 1; slots <= 6; ++slots) {
    for (std::size_t pinned = 0; pinned < slots; ++pinned) {
      SlotScheduler turns(slots);
      for (std::size_t i = 0; i < pinned; ++i) {
        turns.submit(turns.next().value());
        turns.receive();
        ASSERT_TRUE(turns.pin());
      }
      std::deque<std::size_t> order;
      for (std::size_t i = 0; i < 40; ++i) {
        const std::size_t slot = turns.next().value();
        turns.submit(slot);
        turns.receive();
        const auto last = std::ranges::find(order, slot);
        const bool full = order.size() == slots - pinned;
        EXPECT_EQ(last, full ? order.begin() : order.end()) << "the oldest, once all were used";
        order.push_back(slot);
        if (full) order.pop_front();
      }
      EXPECT_EQ(turns.pinned(), pinned);
    }
  }
}

}  // namespace
}  // namespace pillarfield
