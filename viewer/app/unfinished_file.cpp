#include "viewer/app/unfinished_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::filesystem::path part_of(const std::filesystem::path& path) {
  std::filesystem::path name = path.stem();
  name += ".part";
  name += path.extension();
  return path.parent_path() / name;
}

/// A device or directory must never be replaced by the rename at the end.
void require_replaceable(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  throw Error(path.string(), "exists and is no regular file", "choose another name");
}

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw Error(path.string(), std::string("cannot be written: ") + std::strerror(errno),
              "check its directory and the space left on its disk");
}

}  // namespace

UnfinishedFile::UnfinishedFile(std::filesystem::path final_path)
    : final_(std::move(final_path)), part_(part_of(final_)) {
  require_replaceable(final_);
  require_replaceable(part_);
  std::FILE* file = std::fopen(part_.c_str(), "wb");
  if (file == nullptr) fail(final_);
  std::fclose(file);
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(part_, ignored);
}

void UnfinishedFile::append(const std::string& text) const {
  std::unique_ptr<std::FILE, Close> file(std::fopen(part_.c_str(), "ab"));
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail(final_);
  if (std::fclose(file.release()) != 0) fail(final_);
}

void UnfinishedFile::commit() {
  std::error_code error;
  std::filesystem::rename(part_, final_, error);
  if (error) {
    throw Error(final_.string(), "cannot take its name: " + error.message(), "choose another name");
  }
  committed_ = true;
}

}  // namespace pillarfield::viewer
