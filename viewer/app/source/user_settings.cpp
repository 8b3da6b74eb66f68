#include "viewer/app/source/user_settings.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "pillarfield/live.h"

namespace pillarfield::viewer {
namespace {

constexpr std::string_view kRecent = "recent ";
constexpr std::uintmax_t kMostBytes = 1 << 16;

std::filesystem::path settings_path() {
  // No other thread changes the environment.
  const char* const config = std::getenv("XDG_CONFIG_HOME");  // NOLINT(concurrency-mt-unsafe)
  const char* const home = std::getenv("HOME");               // NOLINT(concurrency-mt-unsafe)
  if (config != nullptr && config[0] == '/') {
    return std::filesystem::path(config) / "pillarfield/viewer.conf";
  }
  if (home != nullptr && home[0] == '/') {
    return std::filesystem::path(home) / ".config/pillarfield/viewer.conf";
  }
  return {};
}

std::string text_in(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes > kMostBytes) return {};
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool is_there(const std::string& source) {
  std::error_code error;
  return is_live_source(source) || std::filesystem::is_regular_file(source, error);
}

}  // namespace

UserSettings::UserSettings() : path_(settings_path()) {
  const std::string text = path_.empty() ? "" : text_in(path_);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kRecent) || recent_.size() == kMostRecent) continue;
    const std::string source = line.substr(kRecent.size());
    if (is_there(source)) recent_.push_back(source);
  }
}

void UserSettings::add_recent(const std::string& source) {
  if (source == "-" || source.find('\n') != std::string::npos) return;
  std::error_code error;
  const std::string name =
      is_live_source(source) ? source : std::filesystem::absolute(source, error).string();
  std::erase(recent_, name);
  recent_.insert(recent_.begin(), name);
  recent_.resize(std::min(recent_.size(), kMostRecent));
}

void UserSettings::save() const noexcept {
  if (path_.empty()) return;
  try {
    std::error_code error;
    std::filesystem::create_directories(path_.parent_path(), error);
    std::filesystem::path part = path_;
    part += "." + std::to_string(getpid());
    std::ofstream file(part, std::ios::trunc);
    for (const std::string& source : recent_) file << kRecent << source << '\n';
    file.close();
    if (file) {
      std::filesystem::rename(part, path_, error);
    } else {
      std::filesystem::remove(part, error);
    }
  } catch (const std::exception&) {
    // Settings that are not remembered do no harm.
  }
}

namespace {

std::vector<std::filesystem::path> scenes_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml") {
      scenes.push_back(std::filesystem::weakly_canonical(entry.path(), error));
    }
  }
  std::ranges::sort(scenes);
  return scenes;
}

}  // namespace

std::vector<std::filesystem::path> scenes_at_hand() {
  std::error_code error;
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& folder :
       {std::filesystem::path("scenes"), program / "../share/pillarfield/scenes",
        program / "../../../scenes"}) {
    std::vector<std::filesystem::path> touches = scenes_in(folder);
    if (touches.empty()) continue;
    for (auto& scene : scenes_in(folder / "touch")) touches.push_back(std::move(scene));
    return touches;
  }
  return {};
}

}  // namespace pillarfield::viewer
