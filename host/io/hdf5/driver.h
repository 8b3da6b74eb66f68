#pragma once

#include <filesystem>
#include <memory>

#include "io/hdf5/handle.h"
#include "pillarfield/output_file.h"

namespace pillarfield::hdf5 {

/// How writing to one file goes; shared by the file and all who write to it.
struct WriteHealth {
  int error_number = 0;  ///< errno of the write that failed, 0 as long as none has
};

/// Throws Error with the system's reason where a write to `file` has failed.
void require_written(const WriteHealth& health, const std::filesystem::path& file);

/// A file access list to create an HDF5 file in `output`, which is locked and empty. The driver
/// neither opens nor truncates a file; it writes to that one, and records a failed write in
/// `health`.
///
/// HDF5 up to 2.x crashes when a write fails while it closes or flushes, as on a full disk. With
/// this driver the first write that fails is the last one tried, and HDF5 is told that all went
/// well; the caller asks require_written() after each call. The file then holds what it would hold
/// had the process been killed at that write, so a SWMR reader finds all flushed frames.
[[nodiscard]] Handle surviving_access(const std::shared_ptr<WriteHealth>& health,
                                      const OutputFile& output);

}  // namespace pillarfield::hdf5
