#pragma once

#include <filesystem>
#include <string>

namespace pillarfield {

/// Options of opening a file for reading.
struct ReadOptions {
  /// The file comes from a trusted source, such as your own programs. Other HDF5 files pass
  /// probe_file() first.
  bool trust = false;
};

/// Reads an HDF5 file in a child process, limited to 2 s of processor time and 1 GB of memory, to
/// protect this process from damaged or hostile files. Throws Error if the child crashes, exceeds
/// its limits, finds damage, or finds a frame of more than 8,388,608 sensels. Files of other
/// formats pass, since only this library reads them; so do files that this process has open through
/// HDF5.
///
/// Cost: some milliseconds (docs/formats.md). The child runs no signal or exit handlers and prints
/// nothing. A file that passes may be opened with ReadOptions::trust.
void probe_file(const std::filesystem::path& path);

/// The version of the HDF5 library, as "1.10.8".
[[nodiscard]] std::string hdf5_version();

}  // namespace pillarfield
