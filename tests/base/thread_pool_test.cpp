#include "base/thread_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <vector>

namespace pillarfield {
namespace {

TEST(ThreadPool, DoesEachPieceOnce) {
  for (const std::size_t members : {1U, 2U, 5U}) {
    ThreadPool team(members);
    for (std::size_t pieces = 0; pieces < 40; ++pieces) {
      std::vector<std::atomic<int>> done(pieces);
      team.run(pieces, [&](std::size_t piece, std::size_t) { ++done.at(piece); });
      for (const auto& times : done) EXPECT_EQ(times, 1);
    }
  }
}

TEST(ThreadPool, SharesPieces) {
  ThreadPool team(2);
  std::atomic<int> inside = 0;
  // Each piece waits until another thread has the other.
  team.run(2, [&](std::size_t, std::size_t) {
    ++inside;
    while (inside < 2) std::this_thread::yield();
  });
  EXPECT_EQ(inside, 2);
}

TEST(ThreadPool, PassesTheMemberOfAPiece) {
  ThreadPool team(3);
  std::array<std::thread::id, 3> threads;
  std::mutex mutex;
  for (int turn = 0; turn < 200; ++turn) {
    team.run(9, [&](std::size_t, std::size_t member) {
      const std::scoped_lock lock(mutex);
      std::thread::id& thread = threads.at(member);
      if (thread == std::thread::id()) thread = std::this_thread::get_id();
      EXPECT_EQ(thread, std::this_thread::get_id()) << member;
    });
  }
  EXPECT_EQ(threads[0], std::this_thread::get_id());
}

TEST(ThreadPool, LeavesASinglePieceToTheCaller) {
  ThreadPool team(4);
  for (int turn = 0; turn < 100; ++turn) {
    std::thread::id worker;
    team.run(1, [&](std::size_t, std::size_t) { worker = std::this_thread::get_id(); });
    ASSERT_EQ(worker, std::this_thread::get_id());
  }
}

TEST(ThreadPool, WaitsForOtherMembers) {
  ThreadPool team(3);
  for (int turn = 0; turn < 20; ++turn) {
    std::atomic<int> done = 0;
    team.run(3, [&](std::size_t piece, std::size_t) {
      if (piece > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++done;
    });
    ASSERT_EQ(done, 3);
  }
}

}  // namespace
}  // namespace pillarfield
