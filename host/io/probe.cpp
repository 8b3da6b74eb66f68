#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <new>
#include <utility>
#include <vector>

#include "base/child_process.h"
#include "io/calibration_format.h"
#include "io/file_kind.h"
#include "io/force_format.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "io/hdf5/readers.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"
#include "pillarfield/read_options.h"

namespace pillarfield {
namespace {

constexpr const char* kDamagedOrTrusted =
    "the file is damaged; use another copy, or trust it with --trust-input";

/// Answer of the child: one letter; the text of an Error follows kRefused.
constexpr char kReadable = 'k';
constexpr char kRefused = 'e';
constexpr char kNoMemory = 'm';

void try_as_it_says(const std::filesystem::path& path) {
  hdf5::File file = hdf5::open_to_read(path, true);
  const std::string format = hdf5::read_text(file, file.id.get(), "format").value_or("");
  if (format == recording_format::kName) {
    (void)read_recording(std::move(file), {.untimed = true});
  } else if (format == force_format::kName) {
    try_forces(std::move(file));
  } else if (format == calibration_format::kName) {
    (void)read_calibration(file);
  }
}

std::string answer_of(const std::function<void()>& attempt) {
  try {
    const hdf5::QuietErrors quiet;
    attempt();
    return {kReadable};
  } catch (const std::bad_alloc&) {
    return {kNoMemory};
  } catch (const std::exception& error) {
    return kRefused + std::string(error.what());
  }
}

/// HDF5 shares its state of an open file with a second opener, so a probe tests nothing; a child
/// would also share that state.
bool is_open_already(const std::filesystem::path& path) {
  struct stat wanted = {};
  if (stat(path.c_str(), &wanted) != 0) return false;
  const ssize_t files = H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_FILE);
  if (files <= 0) return false;
  std::vector<hid_t> ids(static_cast<std::size_t>(files));
  const ssize_t found = H5Fget_obj_ids(H5F_OBJ_ALL, H5F_OBJ_FILE, ids.size(), ids.data());
  for (ssize_t i = 0; i < found; ++i) {
    char name[4096] = "";
    struct stat open_file = {};
    if (H5Fget_name(ids[static_cast<std::size_t>(i)], name, sizeof name) < 0) continue;
    if (stat(name, &open_file) != 0) continue;
    if (open_file.st_dev == wanted.st_dev && open_file.st_ino == wanted.st_ino) return true;
  }
  return false;
}

/// Forks from an HDF5 callback, during which HDF5 holds its lock: no other thread is in HDF5, and
/// the child does not inherit a lock held by another thread.
int fork_within_hdf5() {
  pid_t child = -1;
  H5Piterate(
      H5P_FILE_ACCESS, nullptr,
      [](hid_t, const char*, void* result) {
        *static_cast<pid_t*>(result) = fork();
        return 1;
      },
      &child);
  return child;
}

/// Runs `attempt`, which opens the file, in a child process.
void probe(const std::filesystem::path& path, const std::function<void()>& attempt) {
  const hdf5::QuietErrors quiet;
  if (kind_of(path) != FileKind::hdf5 || is_open_already(path)) return;
  const ChildEnd end =
      run_in_child(path.string(), {}, fork_within_hdf5, [&] { return answer_of(attempt); });
  if (end.returned && end.text[0] == kReadable) return;
  // The text already names the place.
  if (end.returned && end.text[0] == kRefused) throw Error({}, end.text.substr(1));
  if (end.returned) {
    throw Error(path.string(), "opening it needs more than 1 GB of memory", kDamagedOrTrusted);
  }
  if (!end.in_time) {
    throw Error(path.string(), "opening it does not finish within its time limit",
                kDamagedOrTrusted);
  }
  throw Error(path.string(),
              fmt::format("reading it crashes the HDF5 library (signal {}, {})", end.signal,
                          strsignal(end.signal)),
              kDamagedOrTrusted);
}

}  // namespace

hdf5::File open_probed(const std::filesystem::path& path, const ReadOptions& options) {
  if (!options.trust) probe_file(path);
  return hdf5::open_to_read(path);
}

void probe_file(const std::filesystem::path& path) {
  probe(path, [&] { try_as_it_says(path); });
}

void probe_frames(const std::filesystem::path& path, const ReadOptions& options) {
  probe(path, [&] { (void)read_hdf5_frames(hdf5::open_to_read(path, true), options); });
}

}  // namespace pillarfield
