#include "device/kernel_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <system_error>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

namespace fs = std::filesystem;

/// A plan's compiled kernels take 0.2 MB; a full disk makes LLVM abort the process.
constexpr std::uintmax_t kLeastFreeBytes = 16U << 20U;

/// No directory can be created below a device file, so PoCL offers no device.
constexpr const char* kNowhere = "/dev/null/pillarfield";

/// An environment variable; empty and unset are the same.
std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The user's directory is used or refused, never replaced by another.
KernelCache cache_of_user(const std::string& wanted) {
  std::error_code failed;
  const PrivateDirectory found = private_directory(fs::absolute(wanted, failed), kLeastFreeBytes);
  if (found.refused.empty()) return {found.path, {}};
  throw Error("POCL_CACHE_DIR", found.refused, "name another that only you can write, or unset it");
}

/// Default directories of kernels, the preferred one first.
std::vector<fs::path> usual_places() {
  std::vector<fs::path> places;
  const fs::path below = fs::path("pillarfield") / "kernels";
  const fs::path caches = environment("XDG_CACHE_HOME");
  const fs::path home = environment("HOME");
  if (caches.is_absolute()) places.push_back(caches / below);
  if (home.is_absolute()) places.push_back(home / ".cache" / below);
  return places;
}

/// True if PoCL may have given a directory this name: digits of a hash, as letters from A on.
bool is_hash(const fs::path& name) {
  return std::ranges::all_of(name.string(), [](char c) { return c >= 'A' && c <= 'P'; });
}

bool is_older(const fs::path& file, std::chrono::hours age) {
  std::error_code failed;
  const auto written = fs::last_write_time(file, failed);
  return !failed && fs::file_time_type::clock::now() - written > age;
}

/// PoCL never removes a program, and leaves an empty file for each that a process builds, others if
/// it is killed. It writes `last_accessed` at each use.
void remove_old(const fs::path& entry) {
  constexpr std::chrono::hours kLongestBuild{1};
  constexpr std::chrono::hours kUnused{24 * 30};
  std::error_code failed;
  if (entry.filename().string().starts_with("tempfile_")) {
    if (is_older(entry, kLongestBuild)) fs::remove(entry, failed);
    return;
  }
  if (!is_hash(entry.filename())) return;
  for (const auto& program : fs::directory_iterator(entry, failed)) {
    if (!is_hash(program.path().filename())) continue;
    if (is_older(program.path() / "last_accessed", kUnused)) fs::remove_all(program, failed);
  }
}

KernelCache choose_directory(std::unique_ptr<TemporaryDirectory>& temporary) {
  if (const std::string wanted = environment("POCL_CACHE_DIR"); !wanted.empty()) {
    return cache_of_user(wanted);
  }
  std::string refused;
  for (const fs::path& place : usual_places()) {
    const PrivateDirectory found = private_directory(place, kLeastFreeBytes);
    if (found.refused.empty()) return {found.path, {}};
    refused += (refused.empty() ? "" : ", ") + found.refused;
  }
  if (refused.empty()) refused = "HOME and XDG_CACHE_HOME are not set";
  temporary = std::make_unique<TemporaryDirectory>(kLeastFreeBytes);
  if (!temporary->directory().refused.empty()) refused += ", " + temporary->directory().refused;
  return {temporary->directory().path, refused};
}

/// The chosen directory, for the lifetime of the process.
struct ProcessCache {
  ProcessCache() : cache(choose_kernel_cache(temporary)) {
    setenv("POCL_CACHE_DIR", cache.directory.empty() ? kNowhere : cache.directory.c_str(), 1);
  }
  std::unique_ptr<TemporaryDirectory> temporary;
  KernelCache cache;
};

}  // namespace

KernelCache choose_kernel_cache(std::unique_ptr<TemporaryDirectory>& temporary) {
  KernelCache cache = choose_directory(temporary);
  try {
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(cache.directory, absent)) remove_old(entry);
  } catch (const fs::filesystem_error&) {
    // Entries that cannot be removed stay.
  }
  if (cache.not_kept.empty() && environment("POCL_KERNEL_CACHE") == "0") {
    cache.not_kept = "POCL_KERNEL_CACHE is 0";
  }
  return cache;
}

const KernelCache& kernel_cache() {
  static const ProcessCache chosen;
  return chosen.cache;
}

std::string reason_not_to_compile(const DeviceInfo& device) {
  if (device.kernel_cache.empty() && device.kernels_not_kept.empty()) return {};
  return private_directory(kernel_cache().directory, kLeastFreeBytes).refused;
}

}  // namespace pillarfield
