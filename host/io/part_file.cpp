#include "io/part_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A device or directory must never be replaced by the rename at the end.
void require_replaceable(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  throw Error(path.string(), "exists and is no regular file", "choose another name");
}

}  // namespace

PartFile::PartFile(std::filesystem::path final_path)
    : final_(std::move(final_path)), part_(part_of(final_)) {
  require_replaceable(final_);
  require_replaceable(part_);
  std::FILE* file = std::fopen(part_.c_str(), "wb");
  if (file == nullptr) {
    throw Error(part_.string(), std::strerror(errno), "write to a directory that can be written");
  }
  std::fclose(file);
}

PartFile::~PartFile() {
  std::error_code ignored;
  if (!kept_ && !committed_) std::filesystem::remove(part_, ignored);
}

void PartFile::commit() {
  std::error_code error;
  std::filesystem::rename(part_, final_, error);
  if (error) {
    kept_ = true;
    throw Error(final_.string(), "cannot take its name: " + error.message(),
                "the data are complete in " + part_.string());
  }
  committed_ = true;
}

std::filesystem::path PartFile::part_of(const std::filesystem::path& final_path) {
  std::filesystem::path part = final_path;
  return part += ".part";
}

}  // namespace pillarfield
