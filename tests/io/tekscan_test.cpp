#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <sstream>

#include "pillarfield/recording.h"
#include "tests/io/damage.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

/// An export and all its variants of layout. A reading of -1 is written as B.
struct Export {
  std::vector<std::string> header = {"DATA_TYPE MOVIE",
                                     "VERSION Some Measurement System 1.0",
                                     "ROWS 3",
                                     "COLS 4",
                                     "ROW_SPACING 0.5 mm",
                                     "COL_SPACING 0.5 mm",
                                     "NOISE_THRESHOLD 3",
                                     "SECONDS_PER_FRAME 0.5",
                                     "START_FRAME 1",
                                     "END_FRAME 2",
                                     "UNITS raw",
                                     "ASCII_DATA @@"};
  std::vector<std::string> frame_lines = {"Frame 1", "Frame 2"};
  std::vector<std::vector<int>> frames = {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12},
                                          {0, 0, 0, 0, 0, 60, 70, 0, 0, 0, 255, 0}};
  std::size_t cols = 4;
  std::string line_end = "\n";
  std::string row_end;         // after the last cell of each row
  std::string between = "\n";  // before each frame
  std::string end = "@@\n";

  void set(const std::string& key, const std::string& line) {
    for (auto& entry : header) {
      if (entry.starts_with(key + " ")) entry = line;
    }
  }
  void remove(const std::string& key) {
    std::erase_if(header, [&](const auto& entry) { return entry.starts_with(key + " "); });
  }

  [[nodiscard]] std::string text() const {
    std::string lines;
    for (const auto& entry : header) lines += entry + "\n";
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      lines += between + frame_lines[frame] + "\n";
      for (std::size_t i = 0; i < frames[frame].size(); ++i) {
        const int reading = frames[frame][i];
        lines += reading < 0 ? "B" : std::to_string(reading);
        lines += (i + 1) % cols == 0 ? row_end + "\n" : ",";
      }
    }
    lines += end;
    if (line_end == "\n") return lines;
    std::string translated;
    for (const char letter : lines)
      translated += letter == '\n' ? line_end : std::string(1, letter);
    return translated;
  }
};

class Tekscan : public testing::Test {
 protected:
  std::unique_ptr<FrameSource> open(const std::string& text,
                                    std::optional<SkinLayout> layout = {}) {
    write_bytes(path_, text);
    return open_frames(path_, {.layout = layout});
  }
  std::string refused(const std::string& text) {
    return error_of([&] { (void)open(text); });
  }

  /// The readings of all frames of a source.
  static std::vector<std::vector<int>> readings(FrameSource& source) {
    std::vector<std::vector<int>> all;
    const bool bytes = source.sensel_type() == SenselType::u8;
    FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
    for (std::uint64_t index = 0; index < source.frames(); ++index) {
      source.read(index, frame);
      const auto narrow = frame.readings<std::uint8_t>();
      const auto wide = frame.readings<std::uint16_t>();
      if (bytes)
        all.emplace_back(narrow.begin(), narrow.end());
      else
        all.emplace_back(wide.begin(), wide.end());
    }
    return all;
  }

  static bool has(const std::vector<std::string>& sentences, const std::string& part) {
    return std::ranges::any_of(sentences, [&](const std::string& sentence) {
      return sentence.find(part) != std::string::npos;
    });
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "export.asf";
};

TEST_F(Tekscan, GivesReadingsSkinAndTimes) {
  const Export written;
  const auto source = open(written.text());
  EXPECT_EQ(source->format(), "Tekscan ASCII");
  EXPECT_EQ(source->sensel_type(), SenselType::u8);
  EXPECT_EQ(readings(*source), written.frames);
  EXPECT_EQ(times_of(*source), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(source->skin().rows, 3u);
  EXPECT_EQ(source->skin().cols, 4u);
  EXPECT_EQ(source->skin().sensel_pitch_mm, 0.5);
  EXPECT_EQ(source->skin().threshold_counts, 3);
  EXPECT_EQ(source->skin().full_scale_counts, 255);
  EXPECT_EQ(source->skin().counts_per_newton, Skin().counts_per_newton);
  EXPECT_TRUE(has(source->warnings(), "counts per newton"));
  EXPECT_EQ(source->skin().layout, SkinLayout::sensels);
  EXPECT_TRUE(has(source->notes(), "--layout pillars"));
  EXPECT_FALSE(has(source->warnings(), "last of the 3 sensel rows"));
  EXPECT_FALSE(source->has_truth());
  EXPECT_TRUE(source->calibration().empty());
}

/// All line ends and separators of frames give the same frames.
TEST_F(Tekscan, ReadsEveryLayoutAlike) {
  for (const std::string line_end : {"\n", "\r\n"}) {
    for (const std::string row_end : {"", ",", ",, ", " "}) {
      for (const std::string between : {"", "\n", "\n \n"}) {
        for (const std::string end : {"@@\n", "", "\n\n", "@@"}) {
          Export written;
          written.line_end = line_end;
          written.row_end = row_end;
          written.between = between;
          written.end = end;
          EXPECT_EQ(readings(*open(written.text())), written.frames);
          written.header.insert(written.header.begin() + 2, 200, "NOTE walking");
          EXPECT_EQ(readings(*open("\xef\xbb\xbf" + written.text())), written.frames);
        }
      }
    }
  }
}

TEST_F(Tekscan, SenselsThatAnyFrameLacksAreAbsent) {
  Export written;
  written.frames[0][0] = -1;
  written.frames[1][0] = -1;
  written.frames[1][5] = -1;
  const auto source = open(written.text());
  const std::vector<std::uint8_t> mask = {2, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 1};
  EXPECT_EQ(source->calibration().mask, mask);
  written.frames[0][0] = written.frames[1][0] = written.frames[1][5] = 0;
  EXPECT_EQ(readings(*source), written.frames);
  EXPECT_TRUE(has(source->notes(), "2 of 12 cells have no sensel"));
  std::string text = Export().text();
  text.replace(text.find("1,2,3,4"), 1, "-1");
  EXPECT_EQ(open(text)->calibration().mask[0], kAbsent);
}

TEST_F(Tekscan, WidensToSixteenBitsAnywhere) {
  for (std::size_t frame = 0; frame < 2; ++frame) {
    for (std::size_t cell = 0; cell < 12; ++cell) {
      Export written;
      written.frames[frame][cell] = cell % 2 == 0 ? 256 : 65535;
      const auto source = open(written.text());
      EXPECT_EQ(source->sensel_type(), SenselType::u16);
      EXPECT_FALSE(source->skin().full_scale_counts.has_value());
      EXPECT_EQ(readings(*source), written.frames);
    }
  }
}

TEST_F(Tekscan, RowsAndColumnsMayBeAtDifferentDistances) {
  Export written;
  written.set("ROW_SPACING", "ROW_SPACING 0.762 Centimeters");
  written.set("COL_SPACING", "COL_SPACING 0.2  inches");
  const auto source = open(written.text());
  EXPECT_EQ(source->skin().sensel_pitch_mm, Pitch(7.62, 5.08));
  EXPECT_FALSE(has(source->warnings(), "is used for both"));
  const auto pillars = open(written.text(), SkinLayout::pillars);
  EXPECT_EQ(pillars->skin().sensel_pitch_mm, Pitch(std::sqrt(7.62 * 5.08)));
  EXPECT_TRUE(has(pillars->warnings(), "is used for both"));
}

TEST_F(Tekscan, WarnsOfAssumptions) {
  Export written;
  for (const char* key :
       {"ROW_SPACING", "COL_SPACING", "SECONDS_PER_FRAME", "UNITS", "NOISE_THRESHOLD"}) {
    written.remove(key);
  }
  const auto source = open(written.text());
  EXPECT_TRUE(has(source->warnings(), "no spacing"));
  EXPECT_TRUE(has(source->warnings(), "no times"));
  EXPECT_TRUE(has(source->warnings(), "no UNITS"));
  EXPECT_EQ(source->skin().threshold_counts, 0);
  EXPECT_EQ(times_of(*source), (std::vector<double>{0, 1}));
}

TEST_F(Tekscan, PrefersTheTimesOfTheFrames) {
  Export written;
  written.frame_lines = {"Frame 1, 0.25,, 1/2/2020 6:21:52PM", "Frame 2, 0.75"};
  EXPECT_EQ(times_of(*open(written.text())), (std::vector<double>{0.25, 0.75}));
}

TEST_F(Tekscan, HoldsFramesToTheirRawSum) {
  Export written;
  written.frames[0][3] = -1;
  written.frame_lines = {"Frame 1, 0,, now,,,Raw Sum=,,74", "Frame 2, 1,, now,,,Raw Sum=,,385"};
  EXPECT_EQ(open(written.text())->frames(), 2u);
  written.frames[1][5] = 61;
  EXPECT_TRUE(
      has_all(refused(written.text()), {"export.asf:19", "frame 2", "386", "raw sum is 385"}));
}

/// Newtons on the sensels of a frame.
std::vector<float> newtons_in(FrameSource& source, std::uint64_t index) {
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  source.read(index, frame);
  const auto values = frame.readings<float>();
  return {values.begin(), values.end()};
}

TEST_F(Tekscan, GivesForcesInAnyUnits) {
  // One unit on 0.25 mm², in newtons.
  const std::map<std::string, double> newtons = {
      {"KPa", 0.25e-3}, {"kg/cm\xc2\xb2", 0.25 * 0.0980665}, {"lbs", 4.4482216152605}};
  for (const auto& [unit, force] : newtons) {
    SCOPED_TRACE(unit);
    Export written;
    written.set("UNITS", "UNITS " + unit);
    EXPECT_EQ(open(written.text(), SkinLayout::pillars)->skin().counts_per_newton, 0.25);
    const auto source = open(written.text());
    EXPECT_EQ(source->sensel_type(), SenselType::f32);
    EXPECT_EQ(source->skin().counts_per_newton, 1);
    EXPECT_EQ(source->skin().threshold_counts, 0);
    const std::vector<float> read = newtons_in(*source, 1);
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_NEAR(read[i], written.frames[1][i] * force, 1e-5 * read[i]);
    }
  }
  Export written;
  written.set("UNITS", "UNITS kPa\nSENSEL_AREA 0.02 cm2");
  EXPECT_NEAR(newtons_in(*open(written.text()), 1)[5], 60 * 2e-3, 1e-6);
  written.frames[0][0] = -1;  // One pillar of the outline: its normal force is that of its sensels.
  const auto outline = open(written.text(), SkinLayout::pillars);
  EXPECT_TRUE(has(outline->warnings(), "1 pillars stand partly outside"));
  const std::vector<float> spread = newtons_in(*outline, 0);
  for (const std::size_t i : {0U, 1U, 4U, 5U}) EXPECT_NEAR(spread[i], 13 * 2e-3 / 4, 1e-6);
}

struct Mistake {
  std::string name;
  std::function<void(Export&)> make;
  std::vector<std::string> message;
};

const Mistake kMistakes[] = {
    {"other units",
     [](Export& e) { e.set("UNITS", "UNITS furlongs"); },
     {":11:", "UNITS is 'furlongs'", "kPa"}},
    {"pressures without an area",
     [](Export& e) {
       e.set("UNITS", "UNITS kPa");
       e.remove("ROW_SPACING");
       e.remove("COL_SPACING");
     },
     {"area of a sensel", "SENSEL_AREA"}},
    {"area in acres",
     [](Export& e) { e.set("UNITS", "SENSEL_AREA 1 acre"); },
     {":11:", "SENSEL_AREA is '1 acre'"}},
    {"no ROWS", [](Export& e) { e.remove("ROWS"); }, {":13:", "ROWS"}},
    {"ROWS a word", [](Export& e) { e.set("ROWS", "ROWS three"); }, {":3:", "ROWS is 'three'"}},
    {"ROWS absurd", [](Export& e) { e.set("ROWS", "ROWS 70000"); }, {"ROWS is 70000", "65534"}},
    {"ROWS too many",
     [](Export& e) { e.set("ROWS", "ROWS 4"); },
     {":19:", "frame 1 has only 3 of 4 rows"}},
    {"ROWS too few", [](Export& e) { e.set("ROWS", "ROWS 2"); }, {":17:", "more than 2 rows"}},
    {"spacing in feet",
     [](Export& e) { e.set("ROW_SPACING", "ROW_SPACING 0.1 feet"); },
     {":5:", "ROW_SPACING is '0.1 feet'", "mm, cm or inches"}},
    {"threshold at full scale",
     [](Export& e) { e.set("NOISE_THRESHOLD", "NOISE_THRESHOLD 255"); },
     {"full_scale_counts is 255"}},
    {"frame without number",
     [](Export& e) { e.frame_lines[1] = "Frame two"; },
     {":19:", "'Frame two'"}},
    {"frames out of order",
     [](Export& e) { e.frame_lines[1] = "Frame 1"; },
     {":19:", "frame 1 comes after frame 1"}},
    {"one time only", [](Export& e) { e.frame_lines[0] = "Frame 1, 0.1"; }, {":19:", "time"}},
    {"too large a reading",
     [](Export& e) { e.frames[0][5] = 65536; },
     {":16, column 2:", "'65536'", "[0, 65535]"}},
    {"last frame cut",
     [](Export& e) { e.frames[1].resize(8); },
     {":22:", "frame 2 has only 2 of 3 rows"}},
    {"last row cut",
     [](Export& e) {
       e.frames[1].resize(10);
       e.end = "";
     },
     {":22:", "2 of 4 columns"}},
    {"no frames",
     [](Export& e) {
       e.frames.clear();
       e.end = "";
     },
     {"the export has no frame"}},
};

TEST_F(Tekscan, NamesTheLineOfEveryMistake) {
  for (const Mistake& mistake : kMistakes) {
    SCOPED_TRACE(mistake.name);
    Export written;
    mistake.make(written);
    const std::string error = refused(written.text());
    EXPECT_TRUE(has_all(error, {"export.asf"}));
    EXPECT_TRUE(has_all(error, mistake.message));
  }
}

TEST_F(Tekscan, NamesTheColumnOfEveryBadCell) {
  for (const std::string cell :
       {"", " ", "x", "-2", "1.5", "1e3", "nan", "b", "BB", "0x10", "1 2"}) {
    std::string text = Export().text();
    const std::size_t at = text.find("5,6,7,8");
    text.replace(at + 4, 1, cell);
    EXPECT_TRUE(has_all(refused(text), {"export.asf:16, column 3:", "whole number"})) << cell;
  }
}

/// An export truncated anywhere gives an Error or whole frames that were written.
TEST_F(Tekscan, TruncatedAnywhereIsAnErrorOrWholeFrames) {
  Export written;
  written.frame_lines = {"Frame 1, 0,, now,,,Raw Sum=,,78", "Frame 2, 1,, now,,,Raw Sum=,,385"};
  const std::string text = written.text();
  read_cut(path_, text, text.size(), [&](const auto& path) {
    const auto read = readings(*open_frames(path));
    ASSERT_LE(read.size(), 2u);
    for (std::size_t frame = 0; frame < read.size(); ++frame) {
      EXPECT_EQ(read[frame], written.frames[frame]);
    }
  });
}

TEST(RealTekscan, AgreesWithTheRawSumsOfItsSoftware) {
  const std::filesystem::path path =
      std::filesystem::path(PILLARFIELD_TEST_DATA) / "tekscan" / "iscan_6900_finger_45deg.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the real export is not here: " << path;
  const auto source = open_frames(path);
  ASSERT_EQ(source->frames(), 309u);
  EXPECT_EQ(source->skin().rows, 28u);
  EXPECT_EQ(source->skin().cols, 28u);
  EXPECT_DOUBLE_EQ(source->skin().sensel_pitch_mm.col_mm, 1.27);
  EXPECT_EQ(source->skin().threshold_counts, 3);
  EXPECT_EQ(source->sensel_type(), SenselType::u8);

  // An independent oracle: the sums in the text, and the positions of B.
  std::ifstream text(path);
  FrameBuffer frame(SenselType::u8, 28, 28);
  std::uint64_t index = 0;
  std::string absent;
  for (std::string line; std::getline(text, line);) {
    if (line.find("Raw Sum=,,") != std::string::npos) {
      EXPECT_EQ(source->read(index, frame), std::stod(line.substr(line.find(',') + 1)));
      const auto values = frame.readings<std::uint8_t>();
      EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0),
                std::stoi(line.substr(line.find("Raw Sum=,,") + 10)));
      ++index;
    } else if (index == 1 && std::ranges::count(line, ',') == 27) {
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) absent += cell[0] == 'B' ? 'B' : '.';
    }
  }
  EXPECT_EQ(index, 309u);
  std::string masked;
  for (const auto good : source->calibration().mask) masked += good == kAbsent ? 'B' : '.';
  EXPECT_EQ(masked, absent);
}

}  // namespace
}  // namespace pillarfield
