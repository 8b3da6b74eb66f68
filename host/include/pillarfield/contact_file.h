#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_sink.h"
#include "pillarfield/output_file.h"
#include "pillarfield/pressure_unit.h"

namespace pillarfield {

/// Attributes of a table of contacts.
struct ContactFileInfo {
  Pitch element_pitch_mm;
  std::string source;  ///< name of the file of frames
  ContactOptions options;
  SkinLayout layout = SkinLayout::pillars;
  PressureUnit pressure_unit = kPressureUnits.front();
};

/// Creates a sink of contacts alone in the format of the extension of `path` (docs/formats.md;
/// endings_of() lists them). Each frame must have contacts. `replace` limits which existing file
/// it may replace. Throws Error for another extension or a path that cannot be written.
[[nodiscard]] std::unique_ptr<ForceSink> create_contact_sink(const std::filesystem::path& path,
                                                             const ContactFileInfo& info,
                                                             Replace replace = Replace::results);

/// The output of create_contact_sink() for this path, for check_outputs(). Throws Error for another
/// extension.
[[nodiscard]] PlannedOutput planned_contact_file(const std::filesystem::path& path);

}  // namespace pillarfield
