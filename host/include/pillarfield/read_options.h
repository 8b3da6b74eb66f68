#pragma once

#include <filesystem>
#include <string>

namespace pillarfield {

/// How a file is opened to be read.
struct ReadOptions {
  /// Whether it comes from a source that you trust, as your own programs. Other HDF5 files pass
  /// probe_file() first.
  bool trust = false;
};

/// Opens an HDF5 file in a child process that lives at most 2 s of processor time and takes at most
/// a gigabyte of memory, and leads the HDF5 library there over all that opening and reading the
/// file here will lead it over. Throws Error where the child crashes, does not end, or finds that
/// the file is damaged, or that a frame of it has more than 8,388,608 sensels. Files of other
/// formats pass: no library but this one reads them. So does a file that this process has open by
/// HDF5.
///
/// Takes some milliseconds (docs/formats.md). The child makes no call but to HDF5 and this library,
/// runs no handler of signals or of exit, and prints nothing. Once a file has passed it may be
/// opened with ReadOptions::trust.
void probe_file(const std::filesystem::path& path);

/// The version of the HDF5 library, as "1.10.8".
[[nodiscard]] std::string hdf5_version();

}  // namespace pillarfield
