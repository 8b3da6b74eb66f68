// Recordings with HDF5 filters, sound and damaged.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <functional>
#include <numeric>

#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

using io_test::error_of;
using io_test::has_all;
using io_test::number_at;
using io_test::TemporaryDirectory;

constexpr hsize_t kFrames = 11;
constexpr hsize_t kRows = 7;
constexpr hsize_t kCols = 10;
constexpr std::size_t kFrameValues = kRows * kCols;

std::vector<std::uint16_t> sample_readings() {
  std::vector<std::uint16_t> readings(kFrames * kFrameValues);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings[i] = static_cast<std::uint16_t>(number_at(1, i) % 3 == 0 ? number_at(2, i) : 7);
  }
  return readings;
}

hid_t made(hid_t id) {
  EXPECT_GE(id, 0);
  return id;
}

/// A recording of kFrames frames; `filters` sets the filters of the readings, and `write` writes
/// them.
void write_recording(const std::filesystem::path& path, const std::vector<hsize_t>& chunk,
                     hid_t stored_type, const std::function<void(hid_t)>& filters,
                     const std::function<void(hid_t)>& write) {
  const hid_t file = made(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 21);
  const hid_t format = H5Acreate2(file, "format", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(format, text, "pillarfield-recording");
  const hid_t version =
      H5Acreate2(file, "version", H5T_STD_I32BE, scalar, H5P_DEFAULT, H5P_DEFAULT);
  const int one = 1;
  H5Awrite(version, H5T_NATIVE_INT, &one);
  const hid_t group = H5Gcreate2(file, "/frames", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);

  const hsize_t extent[] = {kFrames, kRows, kCols};
  const hsize_t most[] = {H5S_UNLIMITED, H5S_UNLIMITED, H5S_UNLIMITED};
  const hid_t space = H5Screate_simple(3, extent, most);
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 3, chunk.data());
  filters(layout);
  const hid_t raw =
      made(H5Dcreate2(file, "/frames/raw", stored_type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  write(raw);

  const hid_t times = H5Screate_simple(1, extent, nullptr);
  const hid_t time_layout = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t four = 4;
  H5Pset_chunk(time_layout, 1, &four);
  H5Pset_deflate(time_layout, 4);
  const hid_t time = made(H5Dcreate2(file, "/frames/time", H5T_IEEE_F32BE, times, H5P_DEFAULT,
                                     time_layout, H5P_DEFAULT));
  std::vector<double> seconds(kFrames);
  std::iota(seconds.begin(), seconds.end(), 0.0);
  H5Dwrite(time, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, seconds.data());

  for (const hid_t id : {time, raw}) H5Dclose(id);
  for (const hid_t id : {times, space, scalar}) H5Sclose(id);
  for (const hid_t id : {time_layout, layout}) H5Pclose(id);
  for (const hid_t id : {format, version}) H5Aclose(id);
  H5Tclose(text);
  H5Gclose(group);
  EXPECT_GE(H5Fclose(file), 0);
}

void write_all(hid_t raw) {
  H5Dwrite(raw, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, sample_readings().data());
}

/// Checks that frames, read in the order of `indices`, are those that were written.
void expect_frames(const std::filesystem::path& path, const std::vector<std::uint64_t>& indices) {
  const auto source = open_frames(path);
  ASSERT_EQ(source->frames(), kFrames);
  const std::vector<std::uint16_t> expected = sample_readings();
  FrameBuffer frame(SenselType::u16, kRows, kCols);
  for (const std::uint64_t index : indices) {
    EXPECT_EQ(source->time(index), static_cast<double>(index));
    EXPECT_EQ(source->read(index, frame), static_cast<double>(index));
    const auto read = frame.readings<std::uint16_t>();
    ASSERT_TRUE(std::equal(read.begin(), read.end(),
                           expected.begin() + static_cast<std::ptrdiff_t>(index * kFrameValues)))
        << "frame " << index;
  }
}

using FilterSetter = void (*)(hid_t);
constexpr FilterSetter kFilters[] = {
    [](hid_t layout) { H5Pset_deflate(layout, 9); },
    [](hid_t layout) { H5Pset_fletcher32(layout); },
    [](hid_t layout) {
      H5Pset_shuffle(layout);
      H5Pset_deflate(layout, 1);
    },
    [](hid_t layout) {
      H5Pset_shuffle(layout);
      H5Pset_deflate(layout, 4);
      H5Pset_fletcher32(layout);
    },
    [](hid_t layout) {
      H5Pset_fletcher32(layout);
      H5Pset_deflate(layout, 4);
      H5Pset_shuffle(layout);
    },
};

TEST(FilteredReadings, AreThoseThatWereWritten) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  const std::vector<std::vector<hsize_t>> chunks = {
      {1, kRows, kCols}, {4, kRows, kCols}, {3, 4, 3}, {11, 2, 10}, {5, 9, 16}, {64, 1, 1}};
  for (std::size_t filter = 0; filter < std::size(kFilters); ++filter) {
    for (std::size_t number = 0; number < chunks.size(); ++number) {
      const auto& chunk = chunks[number];
      SCOPED_TRACE(testing::Message() << "filters " << filter << ", chunks of " << chunk[0] << " x "
                                      << chunk[1] << " x " << chunk[2]);
      const hid_t stored = (filter + number) % 2 == 0 ? H5T_STD_U16LE : H5T_STD_U16BE;
      write_recording(path, chunk, stored, kFilters[filter], write_all);
      expect_frames(path, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 3, 0, 10});
    }
  }
}

/// The chunk has 84 MB.
TEST(FilteredReadings, OfAChunkOfManyFramesAreReadInAnyOrder) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  write_recording(path, {600'000, kRows, kCols}, H5T_STD_U16LE, kFilters[2], write_all);
  expect_frames(path, {10, 0, 5});
}

/// HDF5 itself checks sizes and checksums of chunks.
TEST(FilteredReadings, ThatDoNotFitTheirChecksumAreRefused) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  write_recording(path, {kFrames, kRows, kCols}, H5T_STD_U16LE, kFilters[1], [](hid_t raw) {
    const std::vector<unsigned char> bytes(kFrames * kFrameValues * 2 + 4, 9);
    const hsize_t start[] = {0, 0, 0};
    EXPECT_GE(H5Dwrite_chunk(raw, H5P_DEFAULT, 0, start, bytes.size(), bytes.data()), 0);
  });
  EXPECT_TRUE(has_all(error_of([&] { expect_frames(path, {0}); }),
                      {"frame 0 of /frames/raw cannot be read", "damaged"}));
}

TEST(FilteredReadings, ThatWereNeverWrittenAreRefused) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  for (const FilterSetter filters : {kFilters[0], FilterSetter([](hid_t) {})}) {
    write_recording(path, {2, kRows, kCols}, H5T_STD_U16LE, filters, [](hid_t) {});
    EXPECT_TRUE(has_all(error_of([&] { (void)open_frames(path); }),
                        {"/frames/raw", "6 chunks, but only 0"}));
  }
}

TEST(FilteredReadings, OfHugeChunksAreRefused) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  write_recording(path, {1'000'000, kRows, kCols}, H5T_STD_U16LE, kFilters[0], write_all);
  EXPECT_TRUE(has_all(error_of([&] { (void)open_frames(path); }),
                      {"/frames/raw", "1000000 x 7 x 10", "128 MiB", "smaller chunks"}));
}

}  // namespace
}  // namespace pillarfield
