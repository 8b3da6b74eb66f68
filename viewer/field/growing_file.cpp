#include "viewer/field/growing_file.h"

#include <system_error>
#include <utility>

namespace pillarfield::viewer {

GrowingFile::GrowingFile(std::filesystem::path path) : path_(std::move(path)), seen_(look()) {}

GrowingFile::Look GrowingFile::look() const {
  std::error_code failed;  // A file that is away for a moment is no reason to end.
  Look found;
  found.bytes = std::filesystem::file_size(path_, failed);
  if (!failed) found.written = std::filesystem::last_write_time(path_, failed);
  return failed ? Look{} : found;
}

bool GrowingFile::has_changed() {
  std::error_code failed;
  if (path_.extension() == ".part" && !std::filesystem::exists(path_, failed)) {
    path_.replace_extension();
  }
  const Look found = look();
  return found != Look{} && std::exchange(seen_, found) != found;
}

}  // namespace pillarfield::viewer
