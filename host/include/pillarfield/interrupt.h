#pragma once

namespace pillarfield {

/// For a program that writes files, once at its start: from now on SIGINT (Ctrl+C), SIGTERM and
/// SIGHUP are noted instead of ending the process, and a second one of a kind ends it. SIGHUP stays
/// ignored where it is (nohup). A file that grows beyond the process's limit is then an Error of
/// the write, not a signal (SIGXFSZ). The library itself never calls this.
void catch_interrupts();

/// Whether an interrupt was noted.
[[nodiscard]] bool is_interrupted();

}  // namespace pillarfield
