#include <cmath>
#include <filesystem>

#include "pillarfield/recording.h"
#include "tests/io/all_readings.h"
#include "tests/io/damage.h"

// The corpus of fuzz/ holds plain data written by NumPy and h5py; tests/cli/plain_data_test.py
// compares their values.

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

const std::filesystem::path kPlainFiles =
    std::filesystem::path(PILLARFIELD_DAMAGED_FILES) / "plain";

ReadOptions untimed() { return {.untimed = true}; }

class PlainTable : public testing::Test {
 protected:
  std::unique_ptr<FrameSource> open(const std::string& text,
                                    const ReadOptions& options = untimed()) {
    write_bytes(path_, text);
    return open_frames(path_, options);
  }
  std::string refused(const std::string& text, const ReadOptions& options = untimed()) {
    return error_of([&] { (void)open(text, options); });
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "table.csv";
};

TEST_F(PlainTable, TakesEverySeparatorAndLineEnd) {
  for (const char* const text :
       {"1,2,3\n4,5,6\n", "1;2;3\r\n4;5;6\r\n", "1\t2\t3\n4\t5\t6", " 1  2 3\n4 5   6 \n",
        "\xef\xbb\xbf# comment\na,b,c\n1, 2 ,3\n4,+5,6.0\n\n\n", "1,2,3,\n4,5,6,\n",
        "\n\n1e0,20e-1,3\n4,5,6"}) {
    SCOPED_TRACE(text);
    const auto source = open(text);
    EXPECT_EQ(source->frames(), 1u);
    EXPECT_EQ(source->sensel_type(), SenselType::u16);
    EXPECT_EQ(all_readings(*source), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(source->time(0), 0);
  }
}

TEST_F(PlainTable, OtherNumbersAreFloats) {
  const auto source = open("1,nan,-3\n4.5,,70000\n");
  EXPECT_EQ(source->sensel_type(), SenselType::f32);
  const auto readings = all_readings(*source);
  EXPECT_TRUE(std::isnan(readings[1]) && std::isnan(readings[4]));
  EXPECT_EQ(readings[2], -3);
  EXPECT_EQ(readings[3], 4.5f);
}

TEST_F(PlainTable, EmptyCellsBetweenTabsAreMissingAtTheEndsToo) {
  const auto source = open("1\t2\t3\n\t5\t6\n7\t8\t\n");
  const auto readings = all_readings(*source);
  ASSERT_EQ(readings.size(), 9);
  EXPECT_TRUE(std::isnan(readings[3]) && std::isnan(readings[8]));
  EXPECT_EQ(readings[4], 5);
  EXPECT_TRUE(has_all(refused("\t2\t3\n\t5\t6\n"), {"empty cell"}));
}

TEST_F(PlainTable, WarnsOfALineThatCountsAsAHeaderWithoutNames) {
  const auto counts = [&](const std::string& text) {
    return std::ranges::count_if(open(text)->warnings(), [](const std::string& warning) {
      return warning.starts_with("The first line counts");
    });
  };
  EXPECT_EQ(counts("0,1,2,3\n1,2,3,4\n"), 1);
  EXPECT_EQ(counts("a,b,c,d\n1,2,3,4\n5,6,7,8\n"), 0);
  EXPECT_EQ(counts("0,1\n2,3\n"), 0);
}

TEST_F(PlainTable, BlankLinesSeparateFrames) {
  const auto source = open("1,2\n3,4\n\n5,6\n7,8\n \n\n9,1\n2,3", {.rate_hz = 4});
  EXPECT_EQ(source->frames(), 3u);
  EXPECT_EQ(source->time(2), 0.5);
  EXPECT_EQ(all_readings(*source), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3}));
}

TEST_F(PlainTable, AFrameMayLieInALineAfterItsTime) {
  const ReadOptions shape = {.frame_size = FrameSize{2, 2}, .untimed = true};
  EXPECT_EQ(all_readings(*open("1,2,3,4\n5,6,7,8\n", shape)),
            (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(open("1,2\n3,4\n5,6\n7,8\n", shape)->frames(), 2u);
  const auto timed = open("t,a,b,c,d\n0.5,1,2,3,4\n0.75,5,6,7,8\n", shape);
  EXPECT_EQ(timed->frames(), 2u);
  EXPECT_EQ(timed->time(1), 0.75);
  EXPECT_EQ(all_readings(*timed)[4], 5);
}

TEST_F(PlainTable, MistakesNameTheirLine) {
  const ReadOptions shape = {.frame_size = FrameSize{2, 2}, .untimed = true};
  EXPECT_TRUE(has_all(refused("1,2\n3\n"), {"table.csv:2", "has 1 numbers", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,x\n"), {"table.csv:2", "'x' in column 2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n"), {"a frame of 1 rows", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n5,6\n", shape), {"holds 3 rows"}));
  EXPECT_TRUE(has_all(refused("1,2,3\n", shape), {"has 3 numbers", "2 x 2 needs 4"}));
  EXPECT_TRUE(has_all(refused("1,1,2,3,4\n1,1,2,3,4\n", shape), {"frame 1 has the time 1"}));
  EXPECT_TRUE(has_all(refused("1,2\n"), {"1 x 2", "2 to 65534"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n7,8\n", {}), {"no times", "--rate"}));
  EXPECT_TRUE(has_all(refused("frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status\n"
                              "0,0,1,1,0.5,0.5,1,15\n"),
                      {"forces"}));
  std::string line;
  for (int i = 0; i < (1 << 19); ++i) line += "1,1,";
  EXPECT_TRUE(has_all(refused(line), {"table.csv:1", "longer", ".npy"}));
}

TEST(PlainData, OptionsThatAFileContradictsAreRefused) {
  const auto refused = [](const char* file, const ReadOptions& options) {
    return error_of([&] { (void)open_frames(kPlainFiles / file, options); });
  };
  EXPECT_TRUE(has_all(refused("seed_stored.npz", {.rate_hz = 5}), {"has times", "--rate"}));
  EXPECT_TRUE(has_all(refused("seed_uint8.npy", {.dataset = "a"}), {"--dataset"}));
  EXPECT_TRUE(has_all(refused("seed_uint8.npy", {.frame_size = FrameSize{9, 9}, .rate_hz = 5}),
                      {"frames are 4 x 6", "--shape"}));
  EXPECT_TRUE(has_all(refused("seed_lines.npy", {.frame_size = FrameSize{4, 7}, .rate_hz = 5}),
                      {"lines of 24 numbers", "28"}));
  EXPECT_TRUE(has_all(refused("seed_uint8.npy", {.rate_hz = -5}), {"-5 Hz"}));
  EXPECT_TRUE(has_all(refused("seed_dataset.h5", {.rate_hz = 5}), {"--dataset", "/raw"}));
  EXPECT_TRUE(
      has_all(refused("seed_dataset.h5", {.dataset = "b", .rate_hz = 5}), {"no dataset /b"}));
  EXPECT_TRUE(has_all(refused("seed_uint8.npy", {.rate_hz = 5, .tare_frames = 10}),
                      {"has 3 frames", "--tare-frames"}));
}

TEST(PlainData, ConstantsOfTheOptionsNeedNoWarning) {
  const auto source = open_frames(kPlainFiles / "seed_uint8.npy", {.untimed = true,
                                                                   .sensel_pitch_mm = 0.5,
                                                                   .counts_per_newton = 100,
                                                                   .threshold_counts = 3,
                                                                   .full_scale_counts = 255});
  EXPECT_TRUE(source->warnings().empty());
  EXPECT_EQ(source->skin().sensel_pitch_mm, 0.5);
  EXPECT_EQ(source->skin().counts_per_newton, 100);
  EXPECT_EQ(source->skin().threshold_counts, 3);
  EXPECT_EQ(source->skin().full_scale_counts, 255);
  EXPECT_TRUE(std::isnan(source->time(1)));
}

TEST(PlainData, TruncatedAndChangedFilesEndInAnError) {
  const TemporaryDirectory directory;
  for (const auto& entry : std::filesystem::directory_iterator(kPlainFiles)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("seed_") || name.ends_with(".h5")) continue;
    SCOPED_TRACE(name);
    for (const ReadOptions& options :
         {untimed(), ReadOptions{.frame_size = FrameSize{4, 6}, .untimed = true}}) {
      const auto read = [&](const auto& path) {
        const auto source = open_frames(path, options);
        if (source->skin().sensels() > 10000 || source->frames() > 1000) return;
        (void)all_readings(*source);
      };
      read_cut(directory / name, bytes_of(entry.path()), 30, read);
      read_changed(directory / name, bytes_of(entry.path()), 60, read);
    }
  }
}

TEST(PlainData, ATruncatedArrayIsRefused) {
  const TemporaryDirectory directory;
  for (const char* const name :
       {"seed_uint8.npy", "seed_float64.npy", "seed_stored.npz", "seed_deflated.npz"}) {
    const std::string whole = bytes_of(kPlainFiles / name);
    for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{20}}) {
      write_bytes(directory / name, whole.substr(0, size));
      EXPECT_NE(error_of([&] { (void)open_frames(directory / name, untimed()); }), "") << name;
    }
  }
}

}  // namespace
}  // namespace pillarfield
