#include "testbed/figures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "pillarfield/error.h"

namespace pillarfield::testbed {
namespace {

namespace fs = std::filesystem;

class Figures : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ =
      fs::temp_directory_path() / ("pillarfield_figures_" + std::to_string(getpid()));
};

TEST_F(Figures, AreDrawnIntoAFolderThatIsMade) {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "gnuplot is not installed";
  }
  draw_figures(folder_ / "new", {});
  for (const char* name :
       {"figure_3_regions", "figure_4_contours", "figure_5_uncertainty", "figure_8_magnitude"}) {
    for (const char* ending : {".svg", ".png"}) {
      const fs::path path = folder_ / "new" / (std::string(name) + ending);
      EXPECT_GT(fs::file_size(path), 10'000U) << path;
    }
  }
}

TEST_F(Figures, NeedAFolder) {
  std::ofstream(folder_) << "a file";
  EXPECT_THROW(draw_figures(folder_, {}), Error);
  EXPECT_TRUE(fs::is_regular_file(folder_));
}

}  // namespace
}  // namespace pillarfield::testbed
