#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <functional>
#include <new>
#include <utility>

#include "base/child_process.h"
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

void try_as_it_says(const InputFile& input) {
  hdf5::File file = hdf5::open_to_read(input, true);
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

[[noreturn]] void fail_for(const ChildEnd& end, const std::filesystem::path& path) {
  if (end.reason == ChildEnd::Reason::interrupted) {
    throw Error(path.string(), "interrupted while it was examined", "start again");
  }
  // A sound file takes some milliseconds of processor time.
  const bool is_idle = end.processor_time < std::chrono::milliseconds(500);
  if (end.reason == ChildEnd::Reason::late && is_idle) {
    throw Error(
        path.string(), "could not be examined within its time limit",
        "its disk or network is slow, or the computer is busy; try again, or copy the file");
  }
  if (end.reason == ChildEnd::Reason::returned) {
    throw Error(path.string(), "opening it needs more than 1 GB of memory", kDamagedOrTrusted);
  }
  if (end.reason == ChildEnd::Reason::late || end.signal == SIGXCPU) {
    throw Error(path.string(), "opening it does not finish within its time limit",
                kDamagedOrTrusted);
  }
  throw Error(path.string(),
              fmt::format("reading it crashes the HDF5 library (signal {}, {})", end.signal,
                          strsignal(end.signal)),
              kDamagedOrTrusted);
}

/// Runs `attempt`, which opens the file, in a child process; then opens the file once more there,
/// since damage may break the HDF5 library for later calls only.
void probe(const InputFile& file, const std::function<void()>& attempt) {
  const hdf5::QuietErrors quiet;
  if (detect_format(file).kind != FileKind::hdf5) return;
  const ChildEnd end =
      run_in_child(file.path().string(), {}, file.descriptor(), fork_within_hdf5, [&] {
        return answer_of([&] {
          attempt();
          (void)hdf5::open_to_read(file, true);
        });
      });
  const bool returned = end.reason == ChildEnd::Reason::returned;
  if (returned && end.text[0] == kReadable) return;
  // The text already names the place.
  if (returned && end.text[0] == kRefused) throw Error({}, end.text.substr(1));
  fail_for(end, file.path());
}

void probe_contents(const InputFile& file) {
  probe(file, [&] { try_as_it_says(file); });
}

}  // namespace

hdf5::File open_probed(const std::filesystem::path& path, const ReadOptions& options) {
  const InputFile file(path);
  if (!options.trust) probe_contents(file);
  return hdf5::open_to_read(file);
}

void probe_file(const std::filesystem::path& path) { probe_contents(InputFile(path)); }

void probe_frames(const InputFile& file, const ReadOptions& options) {
  probe(file, [&] { (void)read_hdf5_frames(hdf5::open_to_read(file, true), options); });
}

}  // namespace pillarfield
