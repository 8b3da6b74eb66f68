#pragma once

#include <filesystem>
#include <memory>

#include "io/hdf5/file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

// What probe_file() runs in its child, and the public functions after it.

/// Opens a file to read it, after probe_file() has passed it unless it is trusted.
[[nodiscard]] hdf5::File open_probed(const std::filesystem::path& path, const ReadOptions& options);

/// A recording, format "pillarfield-recording" version 1.
[[nodiscard]] std::unique_ptr<FrameSource> read_recording(hdf5::File file);

/// Opens all that a ForceFileReader reads.
void try_forces(hdf5::File file);

/// A calibration, format "pillarfield-calibration" version 1.
[[nodiscard]] SkinCalibration read_calibration(const hdf5::File& file);

}  // namespace pillarfield
