// Files that once crashed a reader, hung it, or were read without an error.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <thread>

#include "pillarfield/calibration_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

using io_test::error_of;
using io_test::has_all;

const std::filesystem::path kDamagedFiles = PILLARFIELD_DAMAGED_FILES;

/// Reads all frames of a recording, with their truth.
void read_recording_whole(const std::filesystem::path& path) {
  const auto source = open_frames(path);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  ForceField truth;
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    source->read(index, frame);
    if (source->has_truth()) source->read_truth(index, truth);
  }
}

void read_forces_whole(const std::filesystem::path& path) {
  const ForceFileReader reader(path);
  ForceField forces;
  for (std::uint64_t index = 0; index < reader.frames(); ++index) {
    reader.read(index, forces);
    if (reader.info().contacts) (void)reader.read_contacts(index);
  }
}

struct DamagedFile {
  const char* name;
  void (*read)(const std::filesystem::path&);
  std::vector<std::string> message;
};

const DamagedFile kRefused[] = {
    {"recording/ext_link_fifo.h5", read_recording_whole, {"is a link", "another file"}},
    {"forces/fc_swmr_loop.h5", read_forces_whole, {"/force/", "1099511627776"}},
    {"recording/frames_2e62.h5", read_recording_whole, {"/frames/", "4611686018427387903"}},
    // HDF5 reads a string outside its heap, so its content is random, or the read never ends.
    {"recording/hang_variable_string.h5", read_recording_whole, {}},
    {"recording/short_chunk.h5",
     read_recording_whole,
     {"/frames/raw", "inflates to 16 bytes instead of 20480"}},
    {"recording/sigabrt_variable_string.h5", read_recording_whole, {"damaged"}},
    {"recording/sigbus_number_type.h5", read_recording_whole, {"must be a number, not"}},
    {"recording/sigfpe_chunk_of_zero.h5", read_recording_whole, {"damaged"}},
    {"forces/sigsegv_attribute_name.h5", read_recording_whole, {"damaged"}},
    {"recording/sigsegv_dense_links.h5", read_recording_whole, {"damaged"}},
    {"recording/sigsegv_variable_string.h5", read_recording_whole, {"damaged"}},
};

/// Of this process and of its children.
double processor_seconds() {
  double seconds = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used = {};
    getrusage(who, &used);
    for (const timeval& time : {used.ru_utime, used.ru_stime}) {
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return seconds;
}

TEST(DamagedFiles, EndInOneLine) {
  for (const DamagedFile& file : kRefused) {
    SCOPED_TRACE(file.name);
    const auto path = kDamagedFiles / file.name;
    ASSERT_TRUE(std::filesystem::exists(path));
    const double begin = processor_seconds();
    const std::string error = error_of([&] { file.read(path); });
    EXPECT_TRUE(has_all(error, {path.string()}));
    EXPECT_TRUE(has_all(error, file.message));
    EXPECT_LT(processor_seconds() - begin, 5);
  }
}

/// No reader crashes or hangs on a file of another format.
TEST(DamagedFiles, EndInEveryReader) {
  for (const DamagedFile& file : kRefused) {
    SCOPED_TRACE(file.name);
    const auto path = kDamagedFiles / file.name;
    if (std::string(file.name).find("hang") != std::string::npos) continue;  // 2 s each
    EXPECT_FALSE(is_calibration_file(path));
    (void)is_force_file(path);
    EXPECT_THROW(read_forces_whole(path), Error);
    EXPECT_THROW((void)read_calibration_file(path), Error);
  }
}

/// A child of a process with threads acquires no lock that another thread holds.
TEST(DamagedFiles, AreDetectedWhileOtherThreadsRead) {
  std::array<std::jthread, 4> readers;
  for (std::jthread& reader : readers) {
    reader = std::jthread([] {
      for (int time = 0; time < 5; ++time) {
        EXPECT_THROW(read_recording_whole(kDamagedFiles / "recording/short_chunk.h5"), Error);
        EXPECT_THROW(read_recording_whole(kDamagedFiles / "recording/sigfpe_chunk_of_zero.h5"),
                     Error);
      }
    });
  }
}

}  // namespace
}  // namespace pillarfield
