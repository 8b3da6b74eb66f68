// Recordings that lack what they must hold, or hold what they must not.

#include <algorithm>
#include <cmath>
#include <limits>

#include "pillarfield/recording.h"
#include "tests/io/damage.h"
#include "tests/io/full_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

/// Replaces a dataset by an empty one of another size and type; chunked if `chunk` is given.
void replace(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& extent,
             const std::vector<hsize_t>& chunk = {}) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const std::vector<hsize_t> most(extent.size(), H5S_UNLIMITED);
  const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(),
                                       chunk.empty() ? nullptr : most.data());
  const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
  if (!chunk.empty()) H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data());
  const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Dclose(dataset);
  H5Pclose(layout);
  H5Sclose(space);
}

const double kNoNumber = std::numeric_limits<double>::quiet_NaN();

const Damage kRecordingDamages[] = {
    {"no format", [](hid_t f) { remove_attribute(f, "/", "format"); }, {"no attribute 'format'"}},
    {"other format", [](hid_t f) { set_text(f, "/", "format", "cheese"); }, {"'cheese'"}},
    {"a force file by its format alone",
     [](hid_t f) { set_text(f, "/", "format", "pillarfield-forces"); },
     {"it holds solved forces"}},
    {"no version",
     [](hid_t f) { remove_attribute(f, "/", "version"); },
     {"no attribute 'version'"}},
    {"version 4",
     [](hid_t f) { set_number(f, "/", "version", 4); },
     {"version is 4", "version 1 to 3"}},
    {"version NaN", [](hid_t f) { set_number(f, "/", "version", kNoNumber); }, {"version is nan"}},
    {"no frames", [](hid_t f) { remove_link(f, "/frames"); }, {"has no /frames/raw"}},
    {"no raw", [](hid_t f) { remove_link(f, "/frames/raw"); }, {"has no /frames/raw"}},
    {"no time", [](hid_t f) { remove_link(f, "/frames/time"); }, {"has no /frames/time", "--rate"}},
    {"time integer",
     [](hid_t f) { replace(f, "/frames/time", H5T_STD_I64LE, {5}); },
     {"/frames/time must hold floats"}},
    {"one row of pillars",
     [](hid_t f) {
       replace(f, "/frames/raw", H5T_STD_U8LE, {1, 1, 6});
     },
     {"rows", "[2, 65534]"}},
    {"no columns",
     [](hid_t f) {
       replace(f, "/frames/raw", H5T_STD_U8LE, {1, 6, 0});
     },
     {"6 x 0", "[1, 65534]"}},
    {"too many rows",
     [](hid_t f) {
       replace(f, "/frames/raw", H5T_STD_U8LE, {0, 65535, 2}, {1, 9, 2});
     },
     {"65535 x 2", "[1, 65534]"}},
    {"times the file cannot hold",
     [](hid_t f) { replace(f, "/frames/time", H5T_IEEE_F64LE, {1ull << 60}, {9}); },
     {"/frames/time", "more than the file"}},
    {"chunks that were never written",
     [](hid_t f) {
       replace(f, "/frames/raw", H5T_STD_U8LE, {11, 7, 10}, {2, 7, 10});
     },
     {"/frames/raw", "6 chunks, but only 0"}},
    {"pitch NaN",
     [](hid_t f) { set_number(f, "/skin", "sensel_pitch_mm", kNoNumber); },
     {"/skin", "sensel_pitch_mm is nan"}},
    {"full scale below threshold",
     [](hid_t f) { set_number(f, "/skin", "threshold_counts", 300); },
     {"full_scale_counts is 250"}},
    {"tare of other size",
     [](hid_t f) {
       replace(f, "/calibration/tare", H5T_IEEE_F32LE, {6, 5});
     },
     {"/calibration/tare is 6 x 5", "6 x 6"}},
    {"half a power law",
     [](hid_t f) { set_number(f, "/skin", "power_law_exponent", 1.2); },
     {"/skin", "'power_law_reference_counts'", "both"}},
    {"truth of other size",
     [](hid_t f) {
       replace(f, "/truth/normal", H5T_IEEE_F32LE, {5, 3, 2});
     },
     {"/truth/normal", "3 x 2", "3 x 3"}},
    {"truth without shear",
     [](hid_t f) { remove_link(f, "/truth/shear_x"); },
     {"has no /truth/shear_x"}},
    {"truth of integers",
     [](hid_t f) {
       replace(f, "/truth/normal", H5T_STD_I32LE, {5, 3, 3});
     },
     {"/truth/normal must hold floats"}},
};

TEST(RecordingDamage, EndsInOneError) {
  const TemporaryDirectory directory;
  expect_refused(directory / "r.h5", kRecordingDamages, write_full_recording,
                 [](const auto& path) { (void)open_frames(path); });
}

TEST(RecordingDamage, OfATimeIsReportedWithItsFrame) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  for (const double wrong_s : {kNoNumber, 1.0, 0.5}) {
    write_full_recording(path);
    edit(path, [&](hid_t file) {
      const hid_t dataset = H5Dopen2(file, "/frames/time", H5P_DEFAULT);
      const double times[] = {0, 1, wrong_s, 3, 4};
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times);
      H5Dclose(dataset);
    });
    if (std::isnan(wrong_s)) {
      EXPECT_TRUE(has_all(error_of([&] { (void)open_frames(path); }), {"/frames/time", "frame 2"}));
    } else {
      const auto warnings = open_frames(path)->warnings();
      EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& warning) {
        return bool{has_all(warning, {"first at frame 2", "order of the file"})};
      }));
    }
    std::filesystem::remove(path);
  }
}

TEST(RecordingDefaults, ReplaceMissingConstantsWithAWarning) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  write_full_recording(path);
  edit(path, [](hid_t file) {
    remove_link(file, "/skin");
    remove_link(file, "/truth");
    remove_link(file, "/calibration");
  });
  const auto source = open_frames(path);
  EXPECT_EQ(source->skin().counts_per_newton, Skin().counts_per_newton);
  EXPECT_EQ(source->skin().sensel_pitch_mm, Skin().sensel_pitch_mm);
  EXPECT_FALSE(source->skin().full_scale_counts.has_value());
  EXPECT_FALSE(source->has_truth());
  EXPECT_TRUE(source->calibration().empty());
  ASSERT_EQ(source->warnings().size(), 3u);
  EXPECT_TRUE(has_all(source->warnings()[1], {"counts_per_newton", "320"}));
}

TEST(RecordingLengths, TheSmallestCounts) {
  const TemporaryDirectory directory;
  const auto path = directory / "r.h5";
  write_full_recording(path);
  edit(path, [](hid_t file) {
    const hid_t dataset = H5Dopen2(file, "/truth/shear_y", H5P_DEFAULT);
    const hsize_t extent[] = {3, 3, 3};
    H5Dset_extent(dataset, extent);
    H5Dclose(dataset);
  });
  const auto source = open_frames(path);
  EXPECT_EQ(source->frames(), 3u);
  ASSERT_EQ(source->warnings().size(), 1u);
  EXPECT_TRUE(has_all(source->warnings()[0], {"first 3"}));
}

TEST(FileKinds, OfOthersAreRefused) {
  const TemporaryDirectory directory;
  const auto error_for = [&](const std::string& name) {
    return error_of([&] { (void)open_frames(directory / name); });
  };
  write_bytes(directory / "empty", "");
  write_bytes(directory / "text", "Dear reader,\nthis is no recording.\n");
  write_bytes(directory / "binary", std::string("\0\1\2\3DATA_TYPE", 13));
  write_bytes(directory / "signature.h5", "\x89HDF\r\n\x1a\n");
  std::filesystem::create_directory(directory / "folder");
  EXPECT_TRUE(has_all(error_for("missing"), {"missing", "No such file"}));
  EXPECT_TRUE(has_all(error_for("empty"), {"is empty"}));
  EXPECT_TRUE(has_all(error_for("text"), {"neither an HDF5 recording nor a Tekscan"}));
  EXPECT_TRUE(has_all(error_for("binary"), {"neither an HDF5 recording nor a Tekscan"}));
  EXPECT_TRUE(has_all(error_for("signature.h5"), {"cannot be opened as HDF5"}));
  EXPECT_TRUE(has_all(error_for("folder"), {"is a folder without files of frames"}));
  EXPECT_TRUE(has_all(error_of([] { (void)open_frames("/dev/null"); }), {"not a regular file"}));
}

}  // namespace
}  // namespace pillarfield
