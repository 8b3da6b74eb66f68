#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace pillarfield::viewer {

/// A file that another program may still write to, seen from outside.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path path);

  /// Whether it may have changed since this was last asked, or since it was made: also where it was
  /// written so shortly before that its time could not tell. A file that was written as NAME.part
  /// and is finished goes on under NAME.
  [[nodiscard]] bool may_have_changed();

  /// Calls `open` with the path until it throws no Error nor filesystem_error, five times at most
  /// within a twentieth of a second: its writer may be about it. False where it threw each time;
  /// the file then counts as changed when asked next.
  bool reopen(const std::function<void(const std::filesystem::path&)>& open);

  /// Its name by now.
  [[nodiscard]] const std::filesystem::path& path();

 private:
  struct RenderSettings {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written;
    bool is_settled = false;  ///< a later write would have a later time
  };
  [[nodiscard]] RenderSettings settings() const;

  std::filesystem::path path_;
  RenderSettings seen_;
};

}  // namespace pillarfield::viewer
