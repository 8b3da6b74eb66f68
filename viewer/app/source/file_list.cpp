#include "viewer/app/source/file_list.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "io/file_kind.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"

namespace pillarfield::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 13> kExtensions{".asc",  ".asf", ".csv",  ".dat", ".h5",
                                                       ".hdf5", ".mat", ".mcap", ".npy", ".npz",
                                                       ".toml", ".tsv", ".txt"};

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

/// True if a file of text holds frames, as CMakeLists.txt does not; true for other files.
bool has_frames(const fs::path& file) {
  constexpr std::array<std::string_view, 3> kOfText{".asc", ".dat", ".txt"};
  if (std::ranges::find(kOfText, extension_of(file)) == kOfText.end()) return true;
  try {
    return kind_of(file) == FileKind::frames;
  } catch (const Error&) {
    return false;
  }
}

std::optional<FileList::Entry> listed_entry(const fs::directory_entry& file) {
  FileList::Entry entry{file.path().filename().string()};
  if (entry.name.starts_with('.')) return std::nullopt;
  std::error_code error;
  entry.is_folder = file.is_directory(error);
  if (entry.is_folder) return entry;
  const bool known = std::ranges::find(kExtensions, extension_of(file.path())) != kExtensions.end();
  if (!file.is_regular_file(error) || !known || !has_frames(file.path())) return std::nullopt;
  entry.bytes = file.file_size(error);
  if (error) entry.bytes = 0;
  return entry;
}

/// Throws std::filesystem::filesystem_error.
std::vector<FileList::Entry> entries_in(const fs::path& folder) {
  std::vector<FileList::Entry> entries;
  for (const fs::directory_entry& file : fs::directory_iterator(folder)) {
    if (auto entry = listed_entry(file)) entries.push_back(std::move(*entry));
  }
  std::ranges::sort(entries, {}, [](const FileList::Entry& entry) {
    return std::tuple(!entry.is_folder, in_lower_case(entry.name), entry.name);
  });
  if (folder.has_relative_path()) entries.insert(entries.begin(), FileList::Entry{"..", true});
  return entries;
}

}  // namespace

FileList::FileList(const fs::path& folder) {
  std::error_code error;
  if (!folder.empty()) enter(folder);
  if (folder_.empty()) enter(fs::current_path(error));
  if (folder_.empty()) enter("/");
}

void FileList::enter(const fs::path& folder, const std::string& mark) {
  try {
    const fs::path whole = fs::canonical(folder);
    entries_ = entries_in(whole);
    folder_ = whole;
    failure_.clear();
  } catch (const fs::filesystem_error& error) {
    failure_ = printable(folder.string() + ": " + error.code().message());
    return;
  }
  const auto found = std::ranges::find(entries_, mark, &Entry::name);
  marked_ = found == entries_.end() ? 0 : static_cast<std::size_t>(found - entries_.begin());
  moved_ = true;
}

std::optional<fs::path> FileList::open(std::size_t entry) {
  if (entry >= entries_.size()) return std::nullopt;
  marked_ = entry;
  const Entry opened = entries_[entry];
  if (!opened.is_folder) return folder_ / opened.name;
  if (opened.name == "..") {
    go_up();
  } else {
    enter(folder_ / opened.name);
  }
  return std::nullopt;
}

void FileList::go_up() { enter(folder_.parent_path(), folder_.filename().string()); }

std::optional<fs::path> FileList::take(const InputEvent& event) {
  if (const auto* const key = std::get_if<KeyEvent>(&event)) {
    if (key->pressed && !key->unusable) return take_key(key->key);
  } else if (const auto* const text = std::get_if<TextEvent>(&event)) {
    jump_to(text->character);
  }
  return std::nullopt;
}

std::optional<fs::path> FileList::take_key(int key) {
  constexpr std::ptrdiff_t kPage = 12;
  switch (key) {
    case GLFW_KEY_UP:
      move(-1);
      break;
    case GLFW_KEY_DOWN:
      move(1);
      break;
    case GLFW_KEY_PAGE_UP:
      move(-kPage);
      break;
    case GLFW_KEY_PAGE_DOWN:
      move(kPage);
      break;
    case GLFW_KEY_HOME:
      move(-std::ssize(entries_));
      break;
    case GLFW_KEY_END:
      move(std::ssize(entries_));
      break;
    case GLFW_KEY_BACKSPACE:
      go_up();
      break;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return open(marked_);
    default:
      break;
  }
  return std::nullopt;
}

void FileList::move(std::ptrdiff_t entries) {
  if (entries_.empty()) return;
  const std::ptrdiff_t last = std::ssize(entries_) - 1;
  const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(marked_) + entries;
  marked_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, last));
  moved_ = true;
}

void FileList::jump_to(std::uint32_t letter) {
  if (letter > 0x7f) return;
  const int wanted = std::tolower(static_cast<int>(letter));
  for (std::size_t i = 1; i <= entries_.size(); ++i) {
    const std::size_t at = (marked_ + i) % entries_.size();
    const auto first = static_cast<unsigned char>(entries_[at].name.front());
    if (std::tolower(first) != wanted) continue;
    marked_ = at;
    moved_ = true;
    return;
  }
}

bool FileList::take_moved() { return std::exchange(moved_, false); }

}  // namespace pillarfield::viewer
