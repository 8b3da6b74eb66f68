#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/output_file.h"

namespace pillarfield {

/// Attributes of a table of contacts.
struct ContactFileInfo {
  double pillar_pitch_mm = 0;
  std::string source;  ///< name of the file of frames
  ContactOptions options;
};

/// Writes the contacts of frames to a file, one frame after another. It writes to `path` + ".part",
/// which finish() renames; the destructor without finish() removes the part.
class ContactSink {
 public:
  virtual ~ContactSink() = default;

  /// Appends a frame; frames count from 0. Throws Error if its time is not finite, or the file is
  /// finished or cannot be written.
  virtual void append(const FrameContacts& frame) = 0;

  /// Closes the file and renames the part to its final name.
  virtual void finish() = 0;
};

/// Creates a table of contacts, whose ending selects the format: .csv or .json (docs/formats.md).
/// `replace` says which existing file it may replace. Throws Error for another ending or a path
/// that cannot be written.
[[nodiscard]] std::unique_ptr<ContactSink> create_contact_sink(const std::filesystem::path& path,
                                                               const ContactFileInfo& info,
                                                               Replace replace = Replace::results);

/// The format that create_contact_sink() selects. Throws Error for an unknown ending.
[[nodiscard]] OutputKind kind_of_contact_file(const std::filesystem::path& path);

}  // namespace pillarfield
