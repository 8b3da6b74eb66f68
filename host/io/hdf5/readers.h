#pragma once

#include <filesystem>
#include <memory>

#include "io/file_source.h"
#include "io/hdf5/file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Reads a recording, format "pillarfield-recording".
[[nodiscard]] std::unique_ptr<FileSource> read_recording(hdf5::File file,
                                                         const ReadOptions& options);

/// Reads a recording, or the datasets that the options name in a file of another program.
[[nodiscard]] std::unique_ptr<FileSource> read_hdf5_frames(hdf5::File file,
                                                           const ReadOptions& options);

/// Reads a calibration, format "pillarfield-calibration" version 1.
[[nodiscard]] SkinCalibration read_calibration(const hdf5::File& file);

}  // namespace pillarfield
