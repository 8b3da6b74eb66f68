#include <fmt/format.h>

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

/// Frames of two rows and two columns.
ReadOptions square() { return {.frame_size = FrameSize{2, 2}}; }

std::vector<double> times_of(FrameSource& source) {
  std::vector<double> times_s;
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    times_s.push_back(source.time(index));
  }
  return times_s;
}

class PlainTable : public testing::Test {
 protected:
  /// Two frames of the readings 1 to 8 at these times.
  void expect_two_frames(const std::string& text, const std::vector<double>& times_s,
                         const ReadOptions& options = square()) {
    SCOPED_TRACE(text);
    const auto source = open(text, options);
    EXPECT_EQ(all_readings(*source), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(source->sensel_type(), SenselType::u16);
    EXPECT_EQ(source->frames(), 2);
    EXPECT_EQ(times_of(*source), times_s);
  }

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

TEST_F(PlainTable, RowNumbersOfPandasAreNoReadings) {
  ReadOptions rated = square();
  rated.rate_hz = 2;
  for (const char* const text :
       {",0,1,2,3\n0,1,2,3,4\n1,5,6,7,8\n", ",a,b,c,d\n10,1,2,3,4\n13,5,6,7,8\n",
        ";0;1;2;3\r\n0;1;2;3;4\r\n1;5;6;7;8\r\n", "index,0,1,2,3\n0,1,2,3,4\n1,5,6,7,8\n",
        "Unnamed: 0,0,1,2,3\n0,1,2,3,4\n1,5,6,7,8\n",
        "\"\",\"0\",\"1\",\"2\",\"3\"\n\"0\",1,2,3,4\n\"1\",5,6,7,8\n"}) {
    expect_two_frames(text, {0, 0.5}, rated);
    EXPECT_TRUE(has_all(refused(text, square()), {"no times"}));
  }
  const auto rows = open(",0,1\n0,1,2\n1,3,4\n");
  EXPECT_EQ(all_readings(*rows), (std::vector<float>{1, 2, 3, 4}));
  ReadOptions blocks;
  blocks.rate_hz = 2;
  expect_two_frames(",0,1\n0,1,2\n1,3,4\n\n,0,1\n0,5,6\n1,7,8\n", {0, 0.5}, blocks);
  expect_two_frames(",0,1\n0,1,2\n1,3,4\n2,5,6\n3,7,8\n", {0, 0.5}, rated);
}

TEST_F(PlainTable, IsoTimesAreSecondsSince1970) {
  constexpr double kFirst = 1714564800;  // 2024-05-01 12:00:00 UTC
  const std::vector<double> times_s = {kFirst, kFirst + 0.002};
  const char* const quoted =
      "\"date\",\"a\",\"b\",\"c\",\"d\"\n\"2024-05-01 12:00\",1,2,3,4\n"
      "\"2024-05-01 12:00:00.002\",5,6,7,8\n";
  for (const char* const text :
       {"2024-05-01 12:00:00,1,2,3,4\n2024-05-01 12:00:00.002,5,6,7,8\n",
        "2024-05-01T12:00:00Z;1;2;3;4\n2024-05-01T12:00:00.002Z;5;6;7;8\n",
        ",0,1,2,3\n2024-05-01 12:00:00.000000,1,2,3,4\n2024-05-01 12:00:00.002000,5,6,7,8\n",
        "time,0,1,2,3\n2024-05-01T14:00:00+02:00,1,2,3,4\n2024-05-01T14:00:00.002+02:00,5,6,7,8\n",
        "0,2024-05-01 05:30:00-0630,1,2,3,4\n1,2024-05-01 05:30:00.002-0630,5,6,7,8\n",
        ",stamp,a,b,c,d\n0,2024-05-01 12:00:00,1,2,3,4\n1,2024-05-01 12:00:00.002,5,6,7,8\n",
        "2024-05-01 12:00:00 1 2 3 4\n2024-05-01 12:00:00.002 5 6 7 8\n",
        "2024-05-01T12:00:00+00\t1\t2\t3\t4\n2024-05-01T12:00:00,002\t5\t6\t7\t8\n", quoted}) {
    expect_two_frames(text, times_s);
  }
  ReadOptions blocks;
  expect_two_frames(
      "time,a,b\n2024-05-01 12:00:00,1,2\n2024-05-01 12:00:00,3,4\n\n"
      "2024-05-01 12:00:00.002,5,6\n2024-05-01 12:00:00.002,7,8\n",
      times_s, blocks);
  const auto times_of_days = times_of(*open(
      "1969-12-31 23:59:59,1,2,3,4\n2000-02-29 00:00:00,1,2,3,4\n2016-12-31 23:59:60,1,2,3,4\n",
      square()));
  EXPECT_EQ(times_of_days, (std::vector<double>{-1, 951782400, 1483228800}));
}

TEST_F(PlainTable, AColumnOfTimesHasItsUnit) {
  const auto with_times = [](const char* name, const char* first, const char* second) {
    return fmt::format("{},a,b,c,d\n{},1,2,3,4\n{},5,6,7,8\n", name, first, second);
  };
  const std::vector<double> times_s = {0.5, 0.75};
  for (const char* const name : {"time", "Timestamp", "t", "time_s", "Time (s)", ""}) {
    expect_two_frames(with_times(name, "0.5", "0.75"), times_s);
  }
  for (const char* const name : {"time_ms", "Time [ms]", "t (ms)", "timestamp.ms"}) {
    expect_two_frames(with_times(name, "500", "750"), times_s);
  }
  expect_two_frames(with_times("time_us", "500000", "750000"), times_s);
  expect_two_frames("time,0,1,2,3\n0.5,1,2,3,4\n0.75,5,6,7,8\n", times_s);
  expect_two_frames(",time,0,1,2,3\n0,0.5,1,2,3,4\n1,0.75,5,6,7,8\n", times_s);
  expect_two_frames("time,frame,a,b,c,d\n0.5,0,1,2,3,4\n0.75,1,5,6,7,8\n", times_s);
  expect_two_frames("time,a,b\n0.5,1,2\n0.5,3,4\n\n0.75,5,6\n0.75,7,8\n", times_s, {});
  expect_two_frames("time,a,b\n0.5,1,2\n0.6,3,4\n0.75,5,6\n0.8,7,8\n", times_s);
  const auto warned = [&](const char* first, const char* second, const std::string& words) {
    const auto source = open(with_times("time", first, second), square());
    EXPECT_EQ(std::ranges::count_if(source->warnings(),
                                    [&](const std::string& warning) {
                                      return warning.find(words) != std::string::npos;
                                    }),
              1)
        << words;
    return source->time(1) - source->time(0);
  };
  EXPECT_NEAR(warned("1714564800000", "1714564800002", "milliseconds since 1970"), 0.002, 1e-6);
  EXPECT_NEAR(warned("1714564800000000000", "1714564800002000000", "nanoseconds"), 0.002, 1e-6);
  EXPECT_EQ(warned("0", "66", "66 s apart"), 66);
}

TEST_F(PlainTable, AMissingLastReadingIsNoSeparator) {
  for (const char* const text :
       {"t,a,b,c,d\n0.5,1,2,3,\n0.75,5,,7,8\n", "t,a,b,c,d,\n0.5,1,2,3,NaN,\n0.75,5,nan,7,8,\n"}) {
    SCOPED_TRACE(text);
    const auto readings = all_readings(*open(text, square()));
    ASSERT_EQ(readings.size(), 8);
    EXPECT_TRUE(std::isnan(readings[3]) && std::isnan(readings[5]));
    EXPECT_EQ(readings[7], 8);
  }
  EXPECT_TRUE(std::isnan(all_readings(*open("1,2,3,\n", square()))[3]));
  EXPECT_EQ(all_readings(*open("1,2,3,4,\n", square())), (std::vector<float>{1, 2, 3, 4}));
}

TEST_F(PlainTable, TimesThatAreNoneNameTheirLine) {
  const std::string first = "2024-05-01 12:00:00,1,2,3,4\n";
  for (const char* const time :
       {"12", "", "2024-05-01", "2024-13-01 12:00:00", "2023-02-29 12:00:00", "2024-05-01 24:00:00",
        "2024-05-01 12:60:00", "2024-05-01 12:00:61", "2024-05-01 12:00:00.",
        "2024-05-01 12:00:00x", "2024-05-01 12:00:00+2"}) {
    EXPECT_TRUE(has_all(refused(first + time + ",5,6,7,8\n", square()),
                        {"table.csv:2", "in column 1 is not a time"}));
  }
  EXPECT_TRUE(has_all(refused(first + first, square()), {"frame 1 has the time"}));
  EXPECT_TRUE(has_all(refused("time,a,b\n0,1,2\n1,3,4\n"), {"a time in each line", "--shape"}));
}

TEST_F(PlainTable, MistakesNameTheirLine) {
  const ReadOptions shape = {.frame_size = FrameSize{2, 2}, .untimed = true};
  EXPECT_TRUE(has_all(refused("1,2\n3\n"), {"table.csv:2", "has 1 numbers", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,x\n"), {"table.csv:2", "'x' in column 2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n"), {"a frame of 1 rows", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n5,6\n", shape), {"holds 3 rows"}));
  EXPECT_TRUE(has_all(refused("1,2,3\n", shape), {"has 3 numbers", "2 x 2 needs 4"}));
  EXPECT_TRUE(has_all(refused("1,2\n"), {"1 x 2", "2 to 65534"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n7,8\n", {}), {"no times", "--rate"}));
  EXPECT_TRUE(has_all(refused("frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status\n"
                              "0,0,1,1,0.5,0.5,1,15\n"),
                      {"forces"}));
  std::string line;
  for (int i = 0; i < (1 << 19); ++i) line += "1,1,";
  EXPECT_TRUE(has_all(refused(line), {"table.csv:1", "longer", ".npy"}));
}

TEST_F(PlainTable, TimesThatDoNotRiseAreKeptOrReplacedByARate) {
  const std::string text = "0,1,2,3,4\n0,5,6,7,8\n2,1,2,3,4\n1,1,2,3,4\n1,1,1,1,1\n";
  const auto named = [](const FrameSource& source, const std::vector<std::string>& words) {
    return std::ranges::count_if(source.warnings(), [&](const std::string& warning) {
      return bool{has_all(warning, words)};
    });
  };
  const auto kept = open(text, square());
  EXPECT_EQ(times_of(*kept), (std::vector<double>{0, 0, 2, 1, 1}));
  EXPECT_EQ(named(*kept, {"2 times equal the one before, 1 time steps back, first at frame 1;",
                          "order of the file", "--rate"}),
            1);
  ReadOptions rated = square();
  rated.rate_hz = 10;
  const auto replaced = open(text, rated);
  EXPECT_EQ(times_of(*replaced), (std::vector<double>{0, 0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(named(*replaced, {"frames are 0.1 s apart"}), 1);
  EXPECT_TRUE(has_all(refused("0,1,2,3,4\n1,5,6,7,8\n", rated), {"has times", "leave out --rate"}));
}

TEST(FrameSeriesOf, FilesAndFoldersAreOneSourceInNaturalOrder) {
  const TemporaryDirectory directory;
  const std::filesystem::path folder = directory / "session";
  std::filesystem::create_directory(folder);
  const auto write = [&](const char* name, const std::string& text) {
    write_bytes(folder / name, text);
    return folder / name;
  };
  const auto last = write("frame_10.csv", "9,0.5\n1,1\n");
  const auto first = write("frame_2.csv", "1,2\n3,4\n");
  write("frame_09.csv", "5,6\n7,8\n");
  write(".hidden", "no frame");
  const ReadOptions rated = {.rate_hz = 10};
  for (const auto& source :
       {open_frames(folder, rated),
        open_frames(std::vector{last, folder / "frame_09.csv", first}, rated)}) {
    EXPECT_EQ(source->frames(), 3);
    EXPECT_EQ(source->sensel_type(), SenselType::f32);  // as one of them needs
    EXPECT_EQ(all_readings(*source), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 0.5, 1, 1}));
    EXPECT_EQ(times_of(*source), (std::vector<double>{0, 0.1, 0.2}));
    EXPECT_TRUE(has_all(source->read_as(), {"3 files", "frame_2.csv to frame_10.csv", "2 x 2"}));
  }
  const auto refused = [&](const ReadOptions& options) {
    return error_of([&] { static_cast<void>(open_frames(folder, options)); });
  };
  EXPECT_TRUE(has_all(refused({}), {"no times", "--rate"}));
  write("frame_11.csv", "1,2,3\n4,5,6\n");
  EXPECT_TRUE(has_all(refused(rated), {"frame_11.csv", "2 x 3", "frame_2.csv"}));
  write("notes.txt", "nothing");
  EXPECT_TRUE(has_all(refused(rated), {"several kinds", "4 .csv", "1 .txt", "session/*.csv"}));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  EXPECT_TRUE(has_all(refused(rated), {"session", "without files"}));
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
  EXPECT_EQ(source->skin().sensel_pitch_mm, Pitch(0.5));
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
