// The viewer's command line rejects bad numbers before it opens anything.

#include "viewer/options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pillarfield::viewer {
namespace {

/// Exit status of parsing `--headless --png a.png` and `words`; unset where the program continues.
std::optional<int> status_of(std::vector<std::string> words, Options& options) {
  words.insert(words.begin(),
               {"pillarfield-viewer", "source.toml", "--headless", "--png", "a.png"});
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (std::string& word : words) arguments.push_back(word.data());
  return parse_options(static_cast<int>(arguments.size()), arguments.data(), options);
}

void expect_refused(const std::string& word) {
  Options options;
  testing::internal::CaptureStderr();
  EXPECT_EQ(status_of({word}, options), 2) << word;
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST(ViewerOptions, NumbersAreTaken) {
  Options options;
  EXPECT_FALSE(status_of(
      {"--zoom=2.5", "--scale=2", "--centre=-10,1e6", "--size=640x480", "--range=-0.5:1e30",
       "--view=orbit:-400,90", "--surface=cylinder:30", "--frames=2:7"},
      options));
  EXPECT_EQ(options.zoom, 2.5);
  EXPECT_EQ(options.scale, 2);
  ASSERT_TRUE(options.centre_mm);
  EXPECT_EQ(options.centre_mm->x, -10);
  EXPECT_EQ(options.centre_mm->y, 1e6);
  EXPECT_EQ(options.width, 640U);
  EXPECT_EQ(options.first_frame, 1U);
  EXPECT_EQ(options.end_frame, 7U);
  ASSERT_TRUE(options.range);
  EXPECT_EQ(options.range->low, -0.5F);
}

TEST(ViewerOptions, RejectNumbersThatAreNotFinite) {
  const std::vector<std::string> bad = {"nan", "-nan", "inf", "-inf", "1e999", "x", ""};
  for (const std::string& number : bad) {
    for (const std::string& word :
         {"--zoom=" + number, "--centre=0," + number, "--size=640x" + number,
          "--range=" + number + ":1", "--view=orbit:0," + number, "--surface=cylinder:" + number,
          "--frames=1:" + number}) {
      expect_refused(word);
    }
  }
}

TEST(ViewerOptions, RejectNumbersOutOfRange) {
  for (const char* word : {"--zoom=0", "--zoom=1001", "--scale=5", "--centre=1.1e6,0",
                           "--centre=0,-1e300", "--range=0:1e31", "--size=640.5x480",
                           "--frames=1.5:3", "--frame=-1", "--frame=99999999999999999999"}) {
    expect_refused(word);
  }
}

}  // namespace
}  // namespace pillarfield::viewer
