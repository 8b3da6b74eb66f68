#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "pillarfield/recording.h"
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

TEST_F(PlainTable, TakesEveryLineEndAndFormOfNumbers) {
  for (const char* const text : {"1;2;3\r\n4;5;6\r\n", " 1  2 3\n4 5   6 \n",
                                 "\xef\xbb\xbf# comment\na,b,c\n1, 2 ,3\n4,+5,6.0\n\n\n",
                                 "1,2,3,\n4,5,6,\n", "\n\n1e0,20e-1,3\n4,5,6"}) {
    SCOPED_TRACE(text);
    const auto source = open(text);
    EXPECT_EQ(source->frames(), 1u);
    EXPECT_EQ(source->sensel_type(), SenselType::u16);
    EXPECT_EQ(all_readings(*source), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(source->time(0), 0);
  }
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
  const auto warnings = open("index,a,b,sum\n0,1,2,3\n1,3,4,7\n")->warnings();
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& warning) {
    return bool{has_all(warning, {"left out: index, sum;"})};
  }));
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
        ",0,1,2,3\n2024-05-01 12:00:00.000000,1,2,3,4\n2024-05-01 12:00:00.002000,5,6,7,8\n",
        "time,0,1,2,3\n2024-05-01T14:00:00+02:00,1,2,3,4\n2024-05-01T14:00:00.002+02:00,5,6,7,8\n",
        "0,2024-05-01 05:30:00-0630,1,2,3,4\n1,2024-05-01 05:30:00.002-0630,5,6,7,8\n",
        "2024-05-01 12:00:00 1 2 3 4\n2024-05-01 12:00:00.002 5 6 7 8\n",
        "2024-05-01T12:00:00+00\t1\t2\t3\t4\n2024-05-01T12:00:00,002\t5\t6\t7\t8\n", quoted}) {
    expect_two_frames(text, times_s);
  }
  expect_two_frames("12:30:00.5 AM,1,2,3,4\n1:00:00 PM,5,6,7,8\n", {1800.5, 46800});
  ReadOptions named = square();
  named.times = "1";
  expect_two_frames("0.5\t1\t2\t3\t4\n0.75\t5\t6\t7\t8\n", {0.5, 0.75}, named);
  named = square();
  named.rate_hz = 4;
  expect_two_frames("time,a,b,c,d\n,1,2,3,4\n,5,6,7,8\n", {0, 0.25}, named);
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
  for (const char* const name : {"Timestamp", "t", "Time (s)", "elapsed", "hostTime"})
    expect_two_frames(with_times(name, "0.5", "0.75"), times_s);
  for (const char* const name : {"Time [ms]", "timestamp.ms", "ms", "epoch_ms"})
    expect_two_frames(with_times(name, "500", "750"), times_s);
  expect_two_frames(",time,0,1,2,3\n0,0.5,1,2,3,4\n1,0.75,5,6,7,8\n", times_s);
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
  EXPECT_TRUE(has_all(refused("time,a,b\n0,1,2\n1,3,4\n"), {"a time in each line", "--shape"}));
}

TEST_F(PlainTable, AColumnIsATimeByItsNameOrTypeWhereverItStands) {
  expect_two_frames("# a,b,time_ms,c,d\n1,2,500,3,4\n5,6,750,7,8\n", {0.5, 0.75});
  expect_two_frames("a,b,c,d,clock\n1,2,3,4,23:59:59.500\n5,6,7,8,00:00:00.5\n",
                    {86399.5, 86400.5});
  expect_two_frames("1,2,3,4,8:21:17.5\n5,6,7,8,8:21:18.5\n", {30077.5, 30078.5});
  // Neither the first place nor rising numbers make a time.
  for (const char* const text :
       {"0,1,2,3,4\n1,5,6,7,8\n", "temp_x,a,b,c,d\n0.5,1,2,3,4\n0.75,5,6,7,8\n",
        ",a,b,c,d\n0.5,1,2,3,4\n0.75,5,6,7,8\n"}) {
    const std::string error = refused(text, square());
    EXPECT_TRUE(has_all(error, {"--columns"}) || has_all(error, {"no times", "--rate"})) << error;
    EXPECT_FALSE(has_all(error, {"2-5"}));  // Two lines show no column that counts.
  }
}

TEST_F(PlainTable, ColumnsAreChosenByNameAndNumber) {
  const auto chosen = [](const char* columns) {
    return ReadOptions{.frame_size = FrameSize{2, 2}, .columns = columns, .rate_hz = 2};
  };
  const std::string text = "p_1,x,p_2,y,p_3,z,q_4,w\n1,9,2,9,3,9,4,9\n5,9,6,9,7,9,8,9\n";
  for (const char* const columns : {"p_*,q_4", "1-7:2", "1,3,5,7", "p_?, q*", "1-3:2,p_3,q_4"}) {
    expect_two_frames(text, {0, 0.5}, chosen(columns));
  }
  expect_two_frames("9,1,2,3,4\n9,5,6,7,8\n", {0, 0.5}, chosen("2-5"));
  expect_two_frames("9,2,1,3,4\n9,6,5,7,8\n", {0, 0.5}, chosen("3,2,4-5"));
  ReadOptions timed = chosen("1-5");
  timed.rate_hz.reset();
  expect_two_frames("t,a,b,c,d\n0.5,1,2,3,4\n0.75,5,6,7,8\n", {0.5, 0.75}, timed);
  EXPECT_TRUE(has_all(refused(text, chosen("pressure_*")), {"no column is named", "pressure_*"}));
  EXPECT_TRUE(has_all(refused(text, chosen("1-9")), {"has 8 columns", "1-9"}));
  EXPECT_TRUE(has_all(refused(text, chosen("0-3")), {"none of --columns '0-3'"}));
  EXPECT_TRUE(has_all(refused(text, chosen("3-1")), {"none of --columns"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n", chosen("a*")), {"no line names columns"}));
}

TEST_F(PlainTable, SpreadsheetsAndOtherCountries) {
  ReadOptions rated = square();
  rated.rate_hz = 2;
  for (const char* const text :
       {"2,2\n1,2,3,4\n5,6,7,8\n", "a,b,c,d,,,\n1,2,3,4,,,\n5,6,7,8,,,\n,,,,,,\n",
        "1,2,3,4,,,\n5,6,7,8,,,\n", "sep=;\na;b;c;d\n1,0;2,0;3,0;4\n5;6;7;8\n",
        "1,0\t2,0\t3,0\t4,0\n5\t6\t7\t8\n"}) {
    expect_two_frames(text, {0, 0.5}, rated);
  }
  expect_two_frames("2,2\n1,2,3,4\n5,6,7,8\n", {0, 0.5}, {.rate_hz = 2});
  const auto readings = all_readings(*open("1;NA;null;None\n1,5;-2,25;n/a;-\n"));
  EXPECT_EQ(readings[0], 1);
  EXPECT_EQ(std::ranges::count_if(readings, [](float x) { return std::isnan(x); }), 5);
  EXPECT_EQ(all_readings(*open("1,5;-2,25\n0;3\n")), (std::vector<float>{1.5f, -2.25f, 0, 3}));
}

TEST_F(PlainTable, LongTablesHaveOneReadingALine) {
  for (const char* const text :
       {"frame,time,row,column,value\n0,0.5,0,0,1\n0,0.5,0,1,2\n0,0.5,1,0,3\n0,0.5,1,1,4\n"
        "1,0.75,0,0,5\n1,0.75,0,1,6\n1,0.75,1,0,7\n1,0.75,1,1,8\n",
        "pressure,col,row,time_ms\n8,2,2,750\n7,1,2,750\n1,1,1,500\n2,2,1,500\n3,1,2,500\n"
        "4,2,2,500\n5,1,1,750\n6,2,1,750\n"}) {
    expect_two_frames(text, {0.5, 0.75}, {});
  }
  const std::string text = "t,row,col,force\n0,0,0,1\n0,1,1,2\n";
  EXPECT_TRUE(std::isnan(all_readings(*open(text))[1]));
  EXPECT_TRUE(has_all(refused(text + "0,1,1,3\n"), {"two readings in row 1, column 1"}));
  EXPECT_TRUE(has_all(refused(text + "0,1.5,1,3\n"), {"table.csv:4", "row 1.5"}));
  EXPECT_TRUE(has_all(refused("t,row,col,a,b\n0,0,0,1,2\n"), {"2 readings", "--columns"}));
}

/// Exports of four styles; each frame has 2 x 3 cells and adds up to what it states.
class TextOfFrames : public PlainTable {};

TEST_F(TextOfFrames, OneReaderReadsEveryStyle) {
  const std::string commas =
      "File:,\"C:\\walk.XSN\",,,\r\n,,,,\r\nUnits:,kPa,,,\r\n,,,,\r\n"
      "FRAME,7,,,\r\n,,,,\r\nTime, 08:00:00.500,,,\r\nSENSOR,left,,,\r\nRows,2,,,\r\n"
      "Columns,3,,,\r\nSensel Width (cm),1,,,\r\nSensel Height (cm),2,,,\r\n"
      "Peak Pressure (kPa),40,,,\r\nEst. Load (N),21,,,\r\nStance Peak Pressure,999,,,\r\n"
      "SENSELS,,,,\r\n10,20,0,,\r\n,,,,\r\n0,35,40,,\r\n"
      "FRAME,8,,,\r\nTime, 08:00:00.750,,,\r\nSENSOR,left,,,\r\nPeak Pressure (kPa),40,,,\r\n"
      "Est. Load (N),21,,,\r\nSENSELS,,,,\r\n40,35,0,,\r\n,,,,\r\n0,20,10,,\r\n";
  const auto page = [](int number, const char* cells) {
    return fmt::format(
        "\n\t\tPage {0}\n\n\tMatrix: 64x95 \n\tSensor area: 2.00 cm\xb2\tTime/picture:250.0 ms\n"
        "\tPict-No.: {0}  Force[N]=sum*sensor_area\n\n\t26\t27\t28\tForce\n{1}\f\n",
        number, cells);
  };
  const std::string tabs = page(1,
                                "30\t10.00\t20.00\t0.00\t6.00\n31\t0.00\t35.00\t40.00\t15.00\n"
                                "Force\t2.00\t11.00\t8.00\t21.00\n") +
                           page(2,
                                "30\t40.00\t35.00\t0.00\t15.00\n31\t0.00\t20.00\t10.00\t6.00\n"
                                "Force\t8.00\t11.00\t2.00\t21.00\n");
  const std::string blanks =
      "Pressure export\nUnits: kPa\nCell area: 200 mm2\nFrame rate: 4 Hz\n"
      "Frame 1\n   1  2  3\n1 10 20 0\n2 0 35 40\nTotal force: 21.0 N\n"
      "Frame 2\n   1  2  3\n1 40 35 0\n2 0 20 10\nTotal force: 21.0 N\n";
  const std::string semicolons =
      "Pressure in N/cm2\nSensel area;2 cm2\n"
      "Frame 1;Time;0,5 s\n1,0;2,0;0,0\n0,0;3,5;4,0\nFrame 2;Time;0,75 s\n4;3,5;0\n0;2;1\n";
  for (const auto& [text, first_s] : {std::pair(commas, 28800.5), std::pair(tabs, 0.0),
                                      std::pair(blanks, 0.0), std::pair(semicolons, 0.5)}) {
    SCOPED_TRACE(text);
    const auto source = open(text, {});
    EXPECT_EQ(times_of(*source), (std::vector<double>{first_s, first_s + 0.25}));
    EXPECT_EQ(source->skin().rows, 2);
    EXPECT_EQ(source->skin().counts_per_newton, 1);
    EXPECT_NEAR(source->skin().sensel_pitch_mm.area_mm2(), 200, 1e-9);
    const auto newtons = all_readings(*source);
    const std::vector<float> expected = {2, 4, 0, 0, 7, 8, 8, 7, 0, 0, 4, 2};
    ASSERT_EQ(newtons.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(newtons[i], expected[i], 1e-5);
  }
  const auto damaged = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_TRUE(has_all(refused(damaged(commas, "0,35,40", "0,45,40")), {"table.csv:1", "states a"}));
  EXPECT_TRUE(has_all(refused(damaged(commas, "10,20,0,,\r\n", "")), {"1 x 3", "2 x 3"}));
  EXPECT_TRUE(has_all(refused(damaged(commas, "Units:,kPa", "Units:,psi")), {"unit or its area"}));
  EXPECT_TRUE(has_all(refused(damaged(tabs, "10.00", "12.00")), {"states a force"}));
  EXPECT_TRUE(has_all(refused(damaged(blanks, "21.0", "27.0")), {"states a total force"}));
  EXPECT_TRUE(has_all(refused(damaged(semicolons, "2;1\n", "2\n")), {"table.csv:7", "1 x 3"}));
  EXPECT_TRUE(has_all(refused(damaged(semicolons, "Sensel area", "Volume")), {"--pitch-mm"}));
  EXPECT_EQ(open(commas, {.frame_size = FrameSize{2, 3}})->frames(), 2);
}

TEST_F(TextOfFrames, PartsAreChosenAndLinesWithTimesAreFrames) {
  std::string feet;
  for (int frame = 1; frame < 3; ++frame) {
    feet += fmt::format(
        "FRAME,{}\nSENSOR,left\nSENSELS\n1,2\n3,4\nSENSOR,right\nSENSELS\n5,6\n7,8\n", frame);
  }
  EXPECT_EQ(all_readings(*open(feet))[0], 1);
  EXPECT_EQ(all_readings(*open(feet, {.dataset = "right", .untimed = true}))[0], 5);
  EXPECT_EQ(all_readings(*open(feet, {.dataset = "2", .untimed = true}))[0], 5);
  EXPECT_TRUE(has_all(refused(feet, {.dataset = "hand", .untimed = true}), {"left", "right"}));
  ReadOptions pitched = square();
  pitched.sensel_pitch_mm = std::sqrt(1000);
  const std::string insoles =
      "file name:  a.sol\tdate/time  25.04.23 10.49\npressure values in  kPa\n\nmask: \n"
      "left insole: 1,2\nright insole: 1,2\n\ntime[secs]\t 1\t 2\t 1\t 2\t\n"
      "  0.5\t 1\t 2\t 3\t 4\t\n  0.75\t 5\t 6\t 7\t 8\t\n";
  const auto source = open(insoles, pitched);
  EXPECT_EQ(times_of(*source), (std::vector<double>{0.5, 0.75}));
  EXPECT_NEAR(all_readings(*source)[7], 8, 1e-5);
  EXPECT_TRUE(has_all(refused(insoles, square()), {"pressures in kPa", "--pitch-mm"}));
  EXPECT_EQ(open(insoles + "   MVP\t 9\t 9\t 9\t 9\t\n", pitched)->frames(), 2);
}

TEST_F(PlainTable, CellsWithoutASenselAreNamedAndAbsent) {
  // One cell varies in few frames only, and one rests beside two that are always loaded.
  const auto absent = [&](double nothing, double rest) {
    std::string text;
    for (int frame = 0; frame < 200; ++frame) {
      text += fmt::format("{},{},{},{},{},{}\n", nothing, nothing, rest, 100 + frame % 7,
                          100 + frame % 5, frame == 101 ? 150 : 100);
    }
    const auto source = open(text, {.frame_size = FrameSize{2, 3}, .rate_hz = 10});
    const Calibration& calibration = source->calibration();
    return std::ranges::count(calibration.mask, kAbsent);
  };
  EXPECT_EQ(absent(-1, 100), 2);
  EXPECT_EQ(absent(30000, 100), 2);
  EXPECT_EQ(absent(100, 80), 0);
  EXPECT_EQ(absent(80, 80), 0);
}

TEST_F(PlainTable, MistakesNameTheirLine) {
  const ReadOptions shape = {.frame_size = FrameSize{2, 2}, .untimed = true};
  EXPECT_TRUE(has_all(refused("1,2\n3\n5,6\n"), {"table.csv:2", "has 1 numbers", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,1e39\n"), {"table.csv:2", "'1e39'", "float32"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,x\n"), {"table.csv:2", "'x' in column 2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n"), {"a frame of 1 rows", "2"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n5,6\n", shape), {"holds 3 rows"}));
  EXPECT_TRUE(has_all(refused("1,2,3\n", shape), {"has 3 numbers", "2 x 2 needs 4"}));
  EXPECT_TRUE(has_all(refused("1,2\nA,B\n", shape), {"holds 1 rows"}));
  EXPECT_TRUE(has_all(refused("1,2\n3,4\n\n5,6\n7,8\n", {}), {"no times", "--rate"}));
  EXPECT_TRUE(has_all(refused("frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status\n"
                              "0,0,1,1,0.5,0.5,1,15\n"),
                      {"forces"}));
  std::string line;
  for (int i = 0; i < (1 << 19); ++i) line += "1,1,";
  EXPECT_TRUE(has_all(refused(line), {"table.csv:1", "longer", ".npy"}));
}

TEST_F(PlainTable, TimesThatDoNotRiseAreKeptOrReplacedByARate) {
  const std::string text = "t,a,b,c,d\n0,1,2,3,4\n0,5,6,7,8\n2,1,2,3,4\n1,1,2,3,4\n1,1,1,1,1\n";
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
  EXPECT_TRUE(has_all(refused("t,a,b,c,d\n0,1,2,3,4\n1,5,6,7,8\n", rated),
                      {"has times", "leave out --rate"}));
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
    EXPECT_TRUE(
        has_all(source->notes().front(), {"3 files", "frame_2.csv to frame_10.csv", "2 x 2"}));
  }
  const auto refused = [&](const ReadOptions& options) {
    return error_of([&] { static_cast<void>(open_frames(folder, options)); });
  };
  EXPECT_TRUE(has_all(refused({}), {"no times", "--rate"}));
  write("frame_11.csv", "1,2,3\n4,5,6\n");
  EXPECT_TRUE(has_all(refused(rated), {"frame_11.csv", "2 x 3", "frame_2.csv"}));
  write("notes.txt", "nothing");
  EXPECT_TRUE(has_all(refused(rated), {"2 kinds", "4 of them .csv", "session/*.csv"}));
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
  EXPECT_TRUE(has_all(refused("seed_uint8.npy", {.rate_hz = 5, .tare_frames = 10}),
                      {"has 3 frames", "--tare-frames"}));
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

}  // namespace
}  // namespace pillarfield
