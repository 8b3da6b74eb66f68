#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pillarfield::viewer {

/// Settings that the window keeps between runs, in $XDG_CONFIG_HOME/pillarfield/viewer.conf, else
/// below ~/.config. Without a folder that can be written it remembers nothing.
class UserSettings {
 public:
  static constexpr std::size_t kMostRecent = 8;

  UserSettings();  ///< reads the file; damaged lines are ignored
  void save() const noexcept;

  /// Sources opened last, newest first; files that are gone are left out.
  [[nodiscard]] const std::vector<std::string>& recent() const { return recent_; }
  void add_recent(const std::string& source);

 private:
  std::filesystem::path path_;  ///< empty: none
  std::vector<std::string> recent_;
};

/// Scenes of the working folder, of an installed copy or of the source tree; the demo is the first.
[[nodiscard]] std::vector<std::filesystem::path> scenes_at_hand();

}  // namespace pillarfield::viewer
