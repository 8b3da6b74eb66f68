#pragma once

#include <filesystem>
#include <string>

namespace pillarfield::viewer {

/// A file that is written under another name and takes its own when it is complete: "out.part.png"
/// for "out.png", so that writers that go by the ending still do. Destroyed before commit(), it is
/// removed, and what bore the name stays as it was.
class UnfinishedFile {
 public:
  /// Throws Error where the name is one of a directory or device, or nothing can be written there.
  explicit UnfinishedFile(std::filesystem::path final_path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Where to write; it exists and is empty.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }
  [[nodiscard]] const std::filesystem::path& final_path() const { return final_; }

  /// Writes all of it: `text` at its end. Throws Error where the disk is full.
  void append(const std::string& text) const;

  /// The file, which must be closed, takes its name and replaces what bears it. Throws Error.
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path part_;
  bool committed_ = false;
};

}  // namespace pillarfield::viewer
