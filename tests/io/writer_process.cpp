// Writes frames whose content follows from their index until it is done or the test ends it. Prints
// the number of flushed frames, one line per flush.
//
//     io_writer_process recording|forces|contacts PATH ROWS COLS FRAMES [FILE_SIZE_LIMIT]
//
// ROWS and COLS count pillars. Exit status 3: an Error, whose text is the last line printed.

#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/sample_contacts.h"
#include "tests/io/sample_files.h"

namespace {

// NOLINTNEXTLINE(google-build-using-namespace): a program of that namespace
using namespace pillarfield;
using io_test::fill_frame;
using io_test::sample_forces;

constexpr std::uint32_t kFlushEvery = 4;
constexpr std::uint32_t kForceFlushEvery = 16;

void say(std::uint64_t frames) {
  std::printf("%llu\n", static_cast<unsigned long long>(frames));
  std::fflush(stdout);
}

void write_recording(const std::string& path, std::uint32_t rows, std::uint32_t cols,
                     std::uint64_t frames) {
  Skin skin;
  skin.rows = 2 * rows;
  skin.cols = 2 * cols;
  RecordingWriter writer(path, skin, SenselType::u16, {},
                         {.truth = true, .flush_every = kFlushEvery, .replace = Replace::anything});
  FrameBuffer frame(SenselType::u16, skin.rows, skin.cols);
  for (std::uint64_t index = 0; index < frames; ++index) {
    fill_frame(index, frame);
    const ForceField truth = sample_forces(index, rows, cols);
    writer.append(frame.view(), 0.25 * static_cast<double>(index), &truth);
    if ((index + 1) % kFlushEvery == 0) say(index + 1);
  }
  writer.finish();
}

void write_forces(const std::string& path, std::uint32_t rows, std::uint32_t cols,
                  std::uint64_t frames, bool contacts) {
  ForceFileInfo info = {rows, cols, 1.25, "direct", "a device", "it", false};
  if (contacts) info.contacts.emplace();
  const auto sink = create_force_sink(path, info);
  for (std::uint64_t index = 0; index < frames; ++index) {
    const ForceField forces = sample_forces(index, rows, cols);
    const FrameContacts found = io_test::sample_contacts(index);
    sink->append({.forces = forces.view(),
                  .contacts = contacts ? &found : nullptr,
                  .time_s = 0.25 * static_cast<double>(index)});
    if ((index + 1) % kForceFlushEvery == 0) say(index + 1);
  }
  sink->finish();
}

void limit_file_size(rlim_t bytes) {
  const rlimit limit = {bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);  // writes then fail as on a full disk
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  const std::string kind = argv[1];
  const auto rows = static_cast<std::uint32_t>(std::atoi(argv[3]));
  const auto cols = static_cast<std::uint32_t>(std::atoi(argv[4]));
  const auto frames = static_cast<std::uint64_t>(std::atoll(argv[5]));
  if (argc > 6) limit_file_size(static_cast<rlim_t>(std::atoll(argv[6])));
  try {
    if (kind == "recording") write_recording(argv[2], rows, cols, frames);
    if (kind == "forces") write_forces(argv[2], rows, cols, frames, false);
    if (kind == "contacts") write_forces(argv[2], rows, cols, frames, true);
  } catch (const pillarfield::Error& error) {
    std::printf("%s\n", error.what());
    return 3;
  }
  return 0;
}
