#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app/input/input.h"

namespace pillarfield::viewer {

/// Folders and files of a folder, of which one is marked: the folders first, then the files that
/// may hold a source by their extensions, both in alphabetical order; hidden ones are left out.
class FileList {
 public:
  struct Entry {
    std::string name;  ///< ".." of the folder above
    bool is_folder = false;
    std::uintmax_t bytes = 0;
  };

  /// Lists a folder; where it cannot be read, the working folder.
  explicit FileList(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] std::size_t marked() const { return marked_; }
  [[nodiscard]] const std::string& failure() const { return failure_; }  ///< of the last folder

  /// Lists a folder, or says in failure() why it cannot be read. Marks the entry `mark`.
  void enter(const std::filesystem::path& folder, const std::string& mark = {});

  /// Opens the entry: lists a folder, returns a file.
  std::optional<std::filesystem::path> open(std::size_t entry);

  /// Arrows, Page up and down, Home, End move the mark, a letter moves it to the next name that
  /// begins with it, Enter opens it, Backspace goes to the folder above.
  std::optional<std::filesystem::path> take(const InputEvent& event);

  /// True once after the keyboard moved the mark, which must then be in sight.
  [[nodiscard]] bool take_moved();

 private:
  std::optional<std::filesystem::path> take_key(int key);
  void move(std::ptrdiff_t entries);
  void go_up();
  void jump_to(std::uint32_t letter);

  std::filesystem::path folder_;
  std::vector<Entry> entries_;
  std::size_t marked_ = 0;
  std::string failure_;
  bool moved_ = true;
};

}  // namespace pillarfield::viewer
