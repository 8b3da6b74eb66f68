#pragma once

#include <string>

namespace pillarfield::cli {

/// Asks that this thread, and those it starts from now on, go before all common ones (SCHED_FIFO).
/// Returns why the system refused; empty where it did not.
[[nodiscard]] std::string ask_for_realtime();

/// Asks that the memory the process has now stay in memory. Returns as ask_for_realtime.
[[nodiscard]] std::string ask_for_locked_memory();

}  // namespace pillarfield::cli
