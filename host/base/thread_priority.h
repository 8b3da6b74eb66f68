#pragma once

namespace pillarfield {

/// Lowers the priority of the calling thread, so that it waits where processors are scarce: for
/// work beside a solver that must not be late. On Linux a niceness of 5, about a third of the
/// share.
void yield_to_other_threads();

}  // namespace pillarfield
