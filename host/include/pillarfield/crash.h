#pragma once

namespace pillarfield {

/// For programs that read one file and end, as the commands do: from now on a crash after HDF5 has
/// read an untrusted file, which may have damaged memory, ends the process with exit status 1.
/// Other programs keep the signal, and its core file. A line names the file in both.
void exit_after_crashes();

}  // namespace pillarfield
