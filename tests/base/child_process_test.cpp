// Ends of a child process.

#include "base/child_process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

using Reason = ChildEnd::Reason;

ChildEnd end_of(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  return run_in_child("a test", limits, -1, fork, work);
}

std::string wait_forever() {
  for (;;) pause();
}

TEST(ChildProcess, ReturnsDiesOrIsLate) {
  const ChildEnd returned = end_of([] { return std::string("text"); });
  EXPECT_EQ(returned.reason, Reason::returned);
  EXPECT_EQ(returned.text, "text");
  const ChildEnd died = end_of([]() -> std::string { _exit(raise(SIGSEGV)); });
  EXPECT_EQ(died.reason, Reason::died);
  EXPECT_EQ(died.signal, SIGSEGV);
  EXPECT_EQ(end_of(wait_forever, {.time = std::chrono::milliseconds(150)}).reason, Reason::late);
}

/// In a process of its own, which stays interrupted.
TEST(ChildProcess, AnInterruptEndsTheWait) {
  EXPECT_EXIT(
      {
        catch_interrupts();
        kill(getpid(), SIGINT);
        _exit(static_cast<int>(end_of(wait_forever).reason));
      },
      testing::ExitedWithCode(static_cast<int>(Reason::interrupted)), "");
}

}  // namespace
}  // namespace pillarfield
