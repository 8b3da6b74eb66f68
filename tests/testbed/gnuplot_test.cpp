#include "testbed/gnuplot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "pillarfield/error.h"

namespace pillarfield::gnuplot {
namespace {

namespace fs = std::filesystem;

bool is_installed() { return std::system("gnuplot --version >/dev/null 2>&1") == 0; }

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Gnuplot : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string error_of(const std::string& script) const {
    try {
      draw(stem_, script);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_ = fs::temp_directory_path() / fmt::format("pillarfield_gnuplot_{}", getpid());
  fs::path stem_ = folder_ / "it's a figure";
};

TEST_F(Gnuplot, DrawsBothFormatsInFull) {
  if (!is_installed()) GTEST_SKIP() << "gnuplot is not installed";
  draw(stem_, "set title 'θ'\nplot x", {300, 200});
  const std::string svg = content_of(stem_.string() + ".svg");
  EXPECT_NE(svg.find("width=\"300\" height=\"200\""), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  const std::string png = content_of(stem_.string() + ".png");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x02\x58\0\0\x01\x90", 8)) << "not 600 x 400";
  EXPECT_EQ(files(), 2);
}

TEST_F(Gnuplot, ReplacesNothingUnlessBothAreDrawn) {
  if (!is_installed()) GTEST_SKIP() << "gnuplot is not installed";
  for (const std::string script : {
           "plot wrong(x)",
           "plot x\nthis is no command",
           "$none << E\nE\nplot x, $none",
           "if (GPVAL_TERM eq 'pngcairo') { plot wrong(x) } else { plot x }",
       }) {
    std::ofstream(stem_.string() + ".svg") << "<svg precious";
    const std::string error = error_of(script);
    EXPECT_NE(error.find("it's a figure"), std::string::npos) << script;
    EXPECT_NE(error.find("gnuplot failed: "), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(content_of(stem_.string() + ".svg"), "<svg precious");
    EXPECT_EQ(files(), 1) << script;
  }
}

TEST_F(Gnuplot, RefusesAnEmptyDrawing) {
  if (!is_installed()) GTEST_SKIP() << "gnuplot is not installed";
  EXPECT_NE(error_of("set title 'no plot'"), "");
  EXPECT_EQ(files(), 0);
}

TEST_F(Gnuplot, NamesAnAbsentFolder) {
  fs::remove(folder_);
  EXPECT_NE(error_of("plot x").find("it's a figure.svg"), std::string::npos);
}

}  // namespace
}  // namespace pillarfield::gnuplot
