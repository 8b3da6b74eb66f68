#include "base/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
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

}  // namespace
}  // namespace pillarfield
