#pragma once

#include <filesystem>
#include <memory>

#include "base/input_file.h"
#include "io/hdf5/handle.h"
#include "pillarfield/output_file.h"

namespace pillarfield::hdf5 {

/// Write status of a file, shared by the file and its driver.
struct WriteStatus {
  int error_number = 0;  ///< errno of the failed write; 0: none failed
};

/// Throws Error with the system's reason if a write to `file` has failed.
void require_written(const WriteStatus& write_status, const std::filesystem::path& file);

/// Returns a file access list that creates an HDF5 file in `output`, which is locked and empty. The
/// driver writes to the open descriptor and records a failed write in `write_status`.
///
/// HDF5 up to 2.x crashes if a write fails during a close or flush, as on a full disk. After the
/// first failed write this driver writes nothing more and reports success; callers call
/// require_written() after each HDF5 call. The file is left as by a process killed at that write,
/// so a SWMR reader finds all flushed frames.
[[nodiscard]] Handle fault_tolerant_access(const std::shared_ptr<WriteStatus>& write_status,
                                           const OutputFile& output);

/// Returns a file access list that reads `input`, wherever its name leads by then, and shares no
/// state with other readers of the same file, as HDF5's own drivers do.
[[nodiscard]] Handle reading_access(const InputFile& input);

}  // namespace pillarfield::hdf5
