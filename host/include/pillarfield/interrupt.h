#pragma once

namespace pillarfield {

/// Makes SIGINT (Ctrl+C), SIGTERM and SIGHUP set is_interrupted() instead of ending the process; a
/// second signal of the same kind ends it. An ignored SIGHUP stays ignored (nohup). A write beyond
/// the limit on file sizes becomes an Error instead of SIGXFSZ. A program calls this once at its
/// start, before it starts threads: a thread of its own waits for the signals, which all others
/// block. The library never calls it.
void catch_interrupts();

/// True once one of these signals has arrived.
[[nodiscard]] bool is_interrupted();

}  // namespace pillarfield
