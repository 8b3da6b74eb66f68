#include "viewer/source/growing_file.h"

#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

/// Upper bound of the resolution of file time stamps.
constexpr std::chrono::milliseconds kTimeResolution(20);

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path path) : path_(std::move(path)), seen_(snapshot()) {}

GrowingFile::Snapshot GrowingFile::snapshot() const {
  std::error_code failed;  // Ignored: a writer may replace the file.
  Snapshot found;
  found.bytes = std::filesystem::file_size(path_, failed);
  if (!failed) found.written = std::filesystem::last_write_time(path_, failed);
  if (failed) return {};
  found.is_final = std::filesystem::file_time_type::clock::now() > found.written + kTimeResolution;
  return found;
}

const std::filesystem::path& GrowingFile::path() {
  std::error_code failed;
  if (path_.extension() == ".part" && !std::filesystem::exists(path_, failed)) {
    path_.replace_extension();
  }
  return path_;
}

bool GrowingFile::reopen(const std::function<void(const std::filesystem::path&)>& open) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    try {
      open(path());
      return true;
    } catch (const Error&) {                              // Try again.
    } catch (const std::filesystem::filesystem_error&) {  // It was just renamed.
    }
  }
  seen_ = {};
  return false;
}

bool GrowingFile::may_have_changed() {
  static_cast<void>(path());
  const Snapshot found = snapshot();
  if (found.bytes == 0) return false;
  const Snapshot before = std::exchange(seen_, found);
  return !before.is_final || before.bytes != found.bytes || before.written != found.written;
}

}  // namespace pillarfield::viewer
