#include "io/output/output_place.h"

#include <sys/stat.h>
#include <unistd.h>

#include <system_error>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Limit of Linux.
constexpr int kMaxLinks = 40;

std::filesystem::path output_folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// Applies the rule of Linux's fs.protected_symlinks.
void require_own_link(const std::filesystem::path& link) {
  struct stat folder = {};
  struct stat found = {};
  if (stat(output_folder_of(link).c_str(), &folder) != 0 || lstat(link.c_str(), &found) != 0)
    return;
  constexpr mode_t kForAll = S_ISVTX | S_IWOTH;
  if ((folder.st_mode & kForAll) != kForAll) return;
  if (found.st_uid == geteuid() || found.st_uid == folder.st_uid) return;
  throw Error(link.string(), "is another user's symbolic link in a directory that all may write",
              "choose another name");
}

std::filesystem::path end_of_links(const std::filesystem::path& path) {
  std::filesystem::path end = path;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(end, error));
       ++links) {
    if (links == kMaxLinks) {
      throw Error(path.string(), "is a symbolic link that leads nowhere", "choose another name");
    }
    require_own_link(end);
    const std::filesystem::path target = std::filesystem::read_symlink(end, error);
    if (error) throw Error(path.string(), error.message(), "choose another name");
    end = target.is_absolute() ? target : output_folder_of(end) / target;
  }
  return end;
}

}  // namespace

OutputPlace place_of_output(const std::filesystem::path& path) {
  if (path == "-") {
    throw Error("-", "this output cannot be written to standard output",
                "name a file; for a file named '-' write ./-");
  }
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw Error(path.string(), "exists and is not a regular file", "choose another name");
  }
  OutputPlace place;
  place.final_path = end_of_links(path);
  if (!place.final_path.has_filename()) {
    throw Error(path.string(), path.empty() ? "the name of an output is empty" : "names no file",
                "give the name of a file");
  }
  place.part_path = place.final_path;
  place.part_path += ".part";
  return place;
}

}  // namespace pillarfield
