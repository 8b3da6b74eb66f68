#pragma once

#include <filesystem>

namespace pillarfield {

/// The name under which a file is written until it is complete: its final name and ".part".
/// Removes that file when destroyed, unless it was kept or has its final name.
class PartFile {
 public:
  /// Creates the part, empty. Throws Error where that or the final name is impossible.
  explicit PartFile(std::filesystem::path final_path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  [[nodiscard]] bool committed() const { return committed_; }

  /// From now on the part outlives this object.
  void keep() { kept_ = true; }

  /// Gives the part, which must be closed, its final name; replaces what bears it.
  void commit();

  [[nodiscard]] static std::filesystem::path part_of(const std::filesystem::path& final_path);

 private:
  std::filesystem::path final_;
  std::filesystem::path part_;
  bool kept_ = false;
  bool committed_ = false;
};

}  // namespace pillarfield
