#pragma once

#include <filesystem>
#include <memory>

#include "pillarfield/contact_file.h"

namespace pillarfield {

[[nodiscard]] std::unique_ptr<ContactSink> create_contact_csv_sink(
    const std::filesystem::path& path, const ContactFileInfo& info, Replace replace);
[[nodiscard]] std::unique_ptr<ContactSink> create_contact_json_sink(
    const std::filesystem::path& path, const ContactFileInfo& info, Replace replace);

/// Throws Error about `path` unless the frame's time is finite.
void check(const FrameContacts& frame, const std::filesystem::path& path);

}  // namespace pillarfield
