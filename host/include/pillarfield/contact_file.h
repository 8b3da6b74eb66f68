#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/output_file.h"

namespace pillarfield {

/// What a table of contacts says of itself.
struct ContactFileInfo {
  double pillar_pitch_mm = 0;
  std::string source;  ///< name of the file the frames came from
  ContactOptions options;
};

/// Takes the contacts of frame after frame. Files are written under `path` + ".part" and get their
/// name in finish(); one destroyed before that is removed.
class ContactSink {
 public:
  virtual ~ContactSink() = default;

  /// Frames are counted from 0. Throws Error where the time is not finite, the file is finished or
  /// cannot be written.
  virtual void append(const FrameContacts& frame) = 0;
  virtual void finish() = 0;
};

/// Makes the sink that the ending of `path` names: .csv or .json (docs/formats.md). `replace` says
/// what of the same name it may replace. Throws Error for another ending or a place that cannot be
/// written.
[[nodiscard]] std::unique_ptr<ContactSink> create_contact_sink(const std::filesystem::path& path,
                                                               const ContactFileInfo& info,
                                                               Replace replace = Replace::results);

/// What create_contact_sink() makes of this path, by its ending. Throws Error for another ending.
[[nodiscard]] OutputKind kind_of_contact_file(const std::filesystem::path& path);

}  // namespace pillarfield
