// Files with a few changed bytes, with and without checksums: older formats, compressed values and
// strings of variable length have none.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <chrono>
#include <cstring>
#include <numeric>

#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

using io_test::bytes_of;
using io_test::has_all;
using io_test::number_at;
using io_test::TemporaryDirectory;
using io_test::write_bytes;

void put_text(hid_t object, const char* name, const char* text, bool variable) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, variable ? H5T_VARIABLE : std::strlen(text));
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (variable) {
    H5Awrite(attribute, type, static_cast<const void*>(&text));
  } else {
    H5Awrite(attribute, type, text);
  }
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

void put_number(hid_t object, const char* name, double value) {
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(object, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(attribute);
  H5Sclose(space);
}

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
  put_text(file, "format", "pillarfield-recording", seed.variable_texts);
  put_number(file, "version", 1);
  for (const char* group : {"/frames", "/skin", "/calibration"}) {
    H5Gclose(H5Gcreate2(file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  }
  put_values(file, "/frames/raw", H5T_STD_U8LE, {5, 6, 6}, seed.gzip);
  put_values(file, "/frames/time", H5T_IEEE_F64LE, {5}, seed.gzip);
  put_values(file, "/calibration/gain", H5T_IEEE_F32LE, {6, 6}, seed.gzip);
  const hid_t skin = H5Gopen2(file, "/skin", H5P_DEFAULT);
  put_number(skin, "counts_per_newton", 320);
  H5Gclose(skin);
  H5Pclose(access);
  EXPECT_GE(H5Fclose(file), 0);
}

void read_whole(const std::filesystem::path& path) {
  const auto source = open_frames(path);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  const std::uint64_t frames = std::min<std::uint64_t>(source->frames(), 100);
  for (std::uint64_t index = 0; index < frames; ++index) source->read(index, frame);
}

/// A damaged file gives an Error or frames, never a crash.
TEST(Mutants, NeverCrash) {
  constexpr Seed kSeeds[] = {{"old", false, false, false},
                             {"old, gzip", false, false, true},
                             {"old, variable strings", false, true, true},
                             {"new, variable strings", true, true, true}};
  constexpr auto kTimeOfSeed = std::chrono::milliseconds(500);
  const TemporaryDirectory directory;
  for (const Seed& seed : kSeeds) {
    SCOPED_TRACE(seed.name);
    write_seed(directory / "whole.h5", seed);
    ASSERT_NO_THROW(read_whole(directory / "whole.h5"));
    const std::string whole = bytes_of(directory / "whole.h5");
    const auto end = std::chrono::steady_clock::now() + kTimeOfSeed;
    for (std::uint64_t trial = 0; std::chrono::steady_clock::now() < end; ++trial) {
      std::string bytes = whole;
      for (std::uint64_t place = 0; place <= trial % 3; ++place) {
        const std::size_t at = number_at(trial, 2 * place) % bytes.size();
        bytes[at] = static_cast<char>(number_at(trial, 2 * place + 1));
      }
      write_bytes(directory / "broken.h5", bytes);
      try {
        read_whole(directory / "broken.h5");
      } catch (const Error& error) {
        EXPECT_TRUE(has_all(error.what(), {"broken.h5"}));
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield
