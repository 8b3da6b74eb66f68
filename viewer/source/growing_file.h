#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace pillarfield::viewer {

/// A file that another program may still be writing.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path path);

  /// True if the file may have changed since the last call (or construction), including a change
  /// within the resolution of its time stamp. NAME.part becomes NAME when its writer finishes.
  [[nodiscard]] bool may_have_changed();

  /// Calls `open` with the path until it succeeds, at most five times within 50 ms, since a writer
  /// may be active. Returns false where each call threw Error or filesystem_error; the file then
  /// counts as changed.
  bool reopen(const std::function<void(const std::filesystem::path&)>& open);

  /// The current name.
  [[nodiscard]] const std::filesystem::path& path();

 private:
  struct Snapshot {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written;
    bool is_final = false;  ///< any later write has a later time stamp
  };
  [[nodiscard]] Snapshot snapshot() const;

  std::filesystem::path path_;
  Snapshot seen_;
};

}  // namespace pillarfield::viewer
