#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "io/output/locked_part.h"
#include "io/output/replaceable.h"
#include "pillarfield/error.h"
#include "pillarfield/output_file.h"

namespace pillarfield {
namespace {

/// Device and inode of a file.
using FileIdentity = std::pair<dev_t, ino_t>;

std::optional<FileIdentity> identity_of(const std::filesystem::path& path) {
  struct stat found = {};
  if (stat(path.empty() ? "." : path.c_str(), &found) != 0) return std::nullopt;
  return FileIdentity{found.st_dev, found.st_ino};
}

/// A set of existing files, and of names at which files may be created.
class FileSet {
 public:
  void add(const std::filesystem::path& path) {
    const Keys keys = keys_of(path);
    if (keys.file) files_.insert(*keys.file);
    if (keys.name) names_.insert(*keys.name);
  }

  [[nodiscard]] bool has(const std::filesystem::path& path) const {
    const Keys keys = keys_of(path);
    return (keys.file && files_.contains(*keys.file)) || (keys.name && names_.contains(*keys.name));
  }

 private:
  using Name = std::pair<FileIdentity, std::string>;  // folder, and name in it
  struct Keys {
    std::optional<FileIdentity> file;
    std::optional<Name> name;
  };

  [[nodiscard]] static Keys keys_of(const std::filesystem::path& path) {
    Keys keys;
    keys.file = identity_of(path);
    if (const auto folder = identity_of(path.parent_path())) {
      keys.name = Name{*folder, path.filename().string()};
    }
    return keys;
  }

  std::set<FileIdentity> files_;
  std::set<Name> names_;
};

void require_no_input(const OutputPlace& place, const std::filesystem::path& path,
                      const std::vector<std::filesystem::path>& inputs) {
  FileSet names;
  FileSet parts;
  names.add(place.final_path);
  parts.add(place.part_path);
  for (const std::filesystem::path& input : inputs) {
    if (input.empty()) continue;
    if (names.has(input)) {
      throw Error(path.string(), "is a file that is read: " + input.string(),
                  "write to another file");
    }
    if (parts.has(input)) {
      throw Error(path.string(),
                  "is first written as a part, which is a file that is read: " + input.string(),
                  "write to another file");
    }
  }
}

void require_writable_folder(const OutputPlace& place) {
  const std::filesystem::path folder = place.final_path.parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0) return;
  throw Error(place.part_path.string(), std::strerror(errno),
              "choose a directory that exists and is writable");
}

}  // namespace

bool name_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  FileSet files;
  files.add(place_of_output(a).final_path);
  return files.has(place_of_output(b).final_path);
}

void check_outputs(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<PlannedOutput>& outputs, Replace replace) {
  FileSet taken;
  for (const PlannedOutput& output : outputs) {
    const OutputPlace place = place_of_output(output.path);
    require_no_input(place, output.path, inputs);
    if (taken.has(place.final_path) || taken.has(place.part_path)) {
      throw Error(output.path.string(), "two outputs cannot share this file",
                  "give each its own name");
    }
    require_replaceable(place.final_path, output.kind, replace);
    if (is_part_left_over(place)) require_disposable(place.part_path, replace);
    require_writable_folder(place);
    taken.add(place.final_path);
    taken.add(place.part_path);
  }
}

}  // namespace pillarfield
