// Written files: pictures, names of sequences, tables.
#include "viewer/app/export/export.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "tests/viewer/app/made_field.h"

namespace pillarfield::viewer {
namespace {

namespace fs = std::filesystem;

class Export : public testing::Test {
 public:
  Export()
      : folder_(fs::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Export() override { fs::remove_all(folder_); }

  /// Names of all files, sorted.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }

 protected:
  fs::path folder_;
};

Pixels noise(std::uint32_t width, std::uint32_t height) {
  Pixels pixels{width, height, {}};
  std::mt19937 random(7);
  for (std::size_t i = 0; i < std::size_t{4} * width * height; ++i) {
    pixels.rgba.push_back(static_cast<std::uint8_t>(random() & 255));
  }
  return pixels;
}

/// A picture decoded by libpng in its stored format.
struct Decoded {
  std::uint32_t width, height, format;
  std::vector<std::uint8_t> bytes;
};

Decoded decode(const fs::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  Decoded decoded{image.width, image.height, image.format, {}};
  decoded.bytes.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, decoded.bytes.data(), 0, nullptr), 0);
  return decoded;
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(Export, PngHoldsThePixelsWithoutAlpha) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {3u, 2u}, {17u, 31u}, {640u, 3u}}) {
    const Pixels pixels = noise(width, height);
    write_png(folder_ / "a.png", pixels);
    const Decoded decoded = decode(folder_ / "a.png");
    EXPECT_EQ(decoded.width, width);
    EXPECT_EQ(decoded.height, height);
    ASSERT_EQ(decoded.format, static_cast<std::uint32_t>(PNG_FORMAT_RGB));
    for (std::size_t i = 0; i < std::size_t{3} * width * height; ++i) {
      ASSERT_EQ(decoded.bytes[i], pixels.rgba[i / 3 * 4 + i % 3]) << i;
    }
  }
  EXPECT_EQ(files(), std::vector<std::string>{"a.png"});
}

TEST_F(Export, APictureThatCannotBeWrittenLeavesNothingAndSaysWhere) {
  const std::string nowhere =
      message_of([&] { write_png(folder_ / "none" / "a.png", noise(2, 2)); });
  EXPECT_NE(nowhere.find("none/a.png"), std::string::npos) << nowhere;
  EXPECT_NE(nowhere.find("choose a directory"), std::string::npos) << nowhere;
  EXPECT_THROW(write_png(folder_ / "a.png", Pixels{}), Error);
  EXPECT_THROW(write_png(folder_ / "a.png", Pixels{2, 2, {1, 2, 3}}), Error);
  EXPECT_TRUE(files().empty());
}

TEST_F(Export, NamesOfASequenceSortByFrame) {
  EXPECT_EQ(numbered("field.png", 12, 100), "field_012.png");
  EXPECT_EQ(numbered("a/b.c/field.png", 3, 9), "a/b.c/field_3.png");
  EXPECT_EQ(numbered("field", 0, 10), "field_00");
  std::string before;
  for (std::uint64_t frame = 0; frame < 1234; ++frame) {
    const std::string name = numbered("x.png", frame, 1234).string();
    EXPECT_LT(before, name);
    before = name;
  }
}

/// The table of a field as the library writes it.
std::string librarys_table(const fs::path& path, const MadeField& made, const ShownField& field) {
  ForceFileInfo info;
  info.rows = made.forces.rows;
  info.cols = made.forces.cols;
  info.element_pitch_mm = made.skin.pillar_pitch_mm();
  info.angles = !field.forces.theta.empty();
  info.uncertainty = !field.forces.uncertainty[Uncertainty::shear_x].empty();
  const auto sink = create_force_sink(path, info);
  sink->append({.forces = field.forces, .time_s = field.time_s});
  sink->finish();
  return text_of(path);
}

TEST_F(Export, TheTableOfAWholeFieldIsTheLibrarys) {
  const MadeField made;
  ShownField field = made.shown();
  field.index = 0;  // The library counts appended frames.
  field.time_s = 0.1;
  const PillarRect all{0, made.forces.rows, 0, made.forces.cols};
  write_csv(folder_ / "ours.csv", field, all);
  EXPECT_EQ(text_of(folder_ / "ours.csv"), librarys_table(folder_ / "its.csv", made, field));

  field.forces.magnitude = field.forces.theta = field.forces.phi = {};
  for (auto& plane : field.forces.uncertainty) plane = {};
  write_csv(folder_ / "ours.csv", field, all);
  EXPECT_EQ(text_of(folder_ / "ours.csv"), librarys_table(folder_ / "its.csv", made, field));
  EXPECT_EQ(files(), (std::vector<std::string>{"its.csv", "ours.csv"}));
}

TEST_F(Export, TheTableOfARectangleHasItsPillarsThatAreNotIdle) {
  const MadeField made;
  const ShownField field = made.shown();
  const PillarRect rect{8, 20, 2, 15};
  write_csv(folder_ / "a.csv", field, rect);
  std::ifstream lines(folder_ / "a.csv");
  std::string line;
  std::getline(lines, line);
  for (std::uint32_t row = rect.row_begin; row < rect.row_end; ++row) {
    for (std::uint32_t col = rect.col_begin; col < rect.col_end; ++col) {
      if (made.forces.status[row * made.forces.cols + col] == 0) continue;
      ASSERT_TRUE(std::getline(lines, line));
      const std::string begin = "400,4," + std::to_string(row) + "," + std::to_string(col) + ",";
      EXPECT_TRUE(line.starts_with(begin)) << line;
    }
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
}

TEST_F(Export, ATableReachesNoFurtherThanTheField) {
  const MadeField made;
  write_csv(folder_ / "a.csv", made.shown(), {0, 32, 0, 40});
  write_csv(folder_ / "b.csv", made.shown(), {0, 1000, 0, 1000});
  EXPECT_EQ(text_of(folder_ / "a.csv"), text_of(folder_ / "b.csv"));
}

}  // namespace
}  // namespace pillarfield::viewer
