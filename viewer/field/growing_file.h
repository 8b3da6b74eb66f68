#pragma once

#include <cstdint>
#include <filesystem>

namespace pillarfield::viewer {

/// A file that another program may still write to, seen from outside.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path path);

  /// Whether it changed since this was last asked, or since it was made. A file that was written as
  /// NAME.part and is finished goes on under NAME.
  [[nodiscard]] bool has_changed();

  /// It counts as changed when asked next.
  void look_again() { seen_ = {}; }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  struct Look {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written;
    friend bool operator==(const Look&, const Look&) = default;
  };
  [[nodiscard]] Look look() const;

  std::filesystem::path path_;
  Look seen_;
};

}  // namespace pillarfield::viewer
