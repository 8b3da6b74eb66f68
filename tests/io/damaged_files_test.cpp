// Files that once crashed a reader, hung it, or were read without an error, and files with a few
// changed bytes.

#include <array>
#include <numeric>
#include <thread>

#include "pillarfield/calibration_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/damage.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

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

/// lab_fuzz_corpus and cli_damaged read those on which HDF5 itself crashes or loops.
const DamagedFile kRefused[] = {
    {"recording/ext_link_fifo.h5", read_recording_whole, {"is a link", "another file"}},
    {"forces/fc_swmr_loop.h5", read_forces_whole, {"/force/", "1099511627776"}},
    {"recording/frames_2e62.h5", read_recording_whole, {"/frames/", "4611686018427387903"}},
    {"recording/sigbus_number_type.h5", read_recording_whole, {"must be a number, not"}},
};

TEST(DamagedFiles, EndInOneLine) {
  for (const DamagedFile& file : kRefused) {
    SCOPED_TRACE(file.name);
    const auto path = kDamagedFiles / file.name;
    ASSERT_TRUE(std::filesystem::exists(path));
    const std::string error = error_of([&] { file.read(path); });
    EXPECT_TRUE(has_all(error, {path.string()}));
    EXPECT_TRUE(has_all(error, file.message));
  }
}

TEST(DamagedFiles, AreRefusedWhileOtherThreadsRead) {
  std::array<std::jthread, 4> readers;
  for (std::jthread& reader : readers) {
    reader = std::jthread([] {
      for (int time = 0; time < 5; ++time) {
        EXPECT_THROW(read_recording_whole(kDamagedFiles / "recording/frames_2e62.h5"), Error);
      }
    });
  }
}

TEST(DamagedFilesDeathTest, EndTheProcessIfHdf5Crashes) {
  const auto path = kDamagedFiles / "recording/sigsegv_dense_links.h5";
  EXPECT_EXIT(read_recording_whole(path), testing::ExitedWithCode(1),
              "sigsegv_dense_links.h5: reading it crashes the HDF5 library; the file is damaged");
}

/// Compressed if `gzip`.
void put_values(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& extent,
                bool gzip) {
  std::size_t values = 1;
  for (const hsize_t size : extent) values *= size;
  std::vector<float> rising(values);
  std::iota(rising.begin(), rising.end(), 1.0f);
  const int rank = static_cast<int>(extent.size());
  const hid_t space = H5Screate_simple(rank, extent.data(), nullptr);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  if (gzip) {
    const std::vector<hsize_t> chunk(extent.size(), 3);
    H5Pset_chunk(layout, rank, chunk.data());
    H5Pset_shuffle(layout);
    H5Pset_deflate(layout, 4);
  }
  const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, rising.data());
  H5Dclose(dataset);
  H5Pclose(layout);
  H5Sclose(space);
}

/// A recording with and without checksums: older formats, compressed values and strings of variable
/// length have none.
struct Seed {
  const char* name;
  bool latest;  ///< format of HDF5
  bool variable_texts;
  bool gzip;
};

void write_seed(const std::filesystem::path& path, const Seed& seed) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  if (seed.latest) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  ASSERT_GE(file, 0);
  set_text(file, "/", "format", "pillarfield-recording", seed.variable_texts);
  set_number(file, "/", "version", 1);
  for (const char* group : {"/frames", "/skin", "/calibration"}) {
    H5Gclose(H5Gcreate2(file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  put_values(file, "/frames/raw", H5T_STD_U8LE, {5, 6, 6}, seed.gzip);
  put_values(file, "/frames/time", H5T_IEEE_F64LE, {5}, seed.gzip);
  put_values(file, "/calibration/gain", H5T_IEEE_F32LE, {6, 6}, seed.gzip);
  set_number(file, "/skin", "counts_per_newton", 320);
  H5Pclose(access);
  EXPECT_GE(H5Fclose(file), 0);
}

TEST(Mutants, NeverCrash) {
  const TemporaryDirectory directory;
  for (const Seed& seed : {Seed{"old", false, false, false}, Seed{"old, gzip", false, false, true},
                           Seed{"old, variable strings", false, true, true},
                           Seed{"new, variable strings", true, true, true}}) {
    SCOPED_TRACE(seed.name);
    const auto path = directory / "whole.h5";
    write_seed(path, seed);
    ASSERT_NO_THROW(read_recording_whole(path));
    read_changed(directory / "broken.h5", bytes_of(path), 40, read_recording_whole);
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace pillarfield
