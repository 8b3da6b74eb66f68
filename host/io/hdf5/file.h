#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/hdf5/driver.h"
#include "io/hdf5/handle.h"
#include "pillarfield/output_file.h"

namespace pillarfield::hdf5 {

/// An open HDF5 file and what messages need of it.
struct File {
  std::filesystem::path path;
  Handle id;
  std::shared_ptr<WriteHealth> health;  ///< of a file that was created
  bool unclosed = false;                ///< its writer was killed or still writes
  bool probing = false;                 ///< see open_to_read
};

/// Opens a file to read it, as a SWMR reader where its writer has not closed it. With `probing`,
/// which is for the child process of probe_file(), those that read its datasets refuse frames
/// beyond kMostProbedValues, and touch what they will read later.
[[nodiscard]] File open_to_read(const std::filesystem::path& path, bool probing = false);

/// Throws Error unless the root attributes `format` and `version` are these.
void require_format(const File& file, std::string_view format, int version);

/// Makes of an output, empty yet, a file in which whatever is flushed survives the death of the
/// process. The output has to stay open for as long. Groups,
/// attributes and datasets have to be made before start_appending(); from then on datasets grow.
[[nodiscard]] File create(const OutputFile& output);
void start_appending(const File& file);
void flush(const File& file);

/// Closes a created file whose datasets are closed; throws Error where not all could be written.
void close(File& file);

/// Makes a group, all of whose parents exist.
[[nodiscard]] Handle create_group(const File& file, const char* name);

}  // namespace pillarfield::hdf5
