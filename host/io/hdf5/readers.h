#pragma once

#include <filesystem>
#include <memory>

#include "io/file_source.h"
#include "io/hdf5/file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

// Readers that probe_file() runs in its child process and the public functions run after it.

/// Opens a file for reading, after probe_file() unless it is trusted.
[[nodiscard]] hdf5::File open_probed(const std::filesystem::path& path, const ReadOptions& options);

/// Reads a recording, format "pillarfield-recording".
[[nodiscard]] std::unique_ptr<FileSource> read_recording(hdf5::File file,
                                                         const ReadOptions& options);

/// Reads a recording, or the datasets that the options name in a file of another program.
[[nodiscard]] std::unique_ptr<FileSource> read_hdf5_frames(hdf5::File file,
                                                           const ReadOptions& options);

/// As probe_file(), for read_hdf5_frames().
void probe_frames(const InputFile& file, const ReadOptions& options);

/// Opens everything that a ForceFileReader reads.
void try_forces(hdf5::File file);

/// Reads a calibration, format "pillarfield-calibration" version 1.
[[nodiscard]] SkinCalibration read_calibration(const hdf5::File& file);

}  // namespace pillarfield
