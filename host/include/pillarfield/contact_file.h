#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_sink.h"
#include "pillarfield/output_file.h"

namespace pillarfield {

/// Attributes of a table of contacts.
struct ContactFileInfo {
  double pillar_pitch_mm = 0;
  std::string source;  ///< name of the file of frames
  ContactOptions options;
};

/// Makes a sink of contacts alone in the format that the ending of `path` names (docs/formats.md;
/// endings_of() lists them). Each frame must have contacts. `replace` says what of the same name it
/// may replace. Throws Error for another ending or a place that cannot be written.
[[nodiscard]] std::unique_ptr<ForceSink> create_contact_sink(const std::filesystem::path& path,
                                                             const ContactFileInfo& info,
                                                             Replace replace = Replace::results);

/// What create_contact_sink() makes of this path, for check_outputs(). Throws Error for another
/// ending.
[[nodiscard]] PlannedOutput planned_contact_file(const std::filesystem::path& path);

}  // namespace pillarfield
