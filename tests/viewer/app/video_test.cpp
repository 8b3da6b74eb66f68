// Videos, by ffmpeg where installed, and failures, by stand-ins for ffmpeg.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/io/sample_files.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {
namespace {

namespace fs = std::filesystem;

Pixels grey(std::uint32_t width, std::uint32_t height, std::uint8_t level) {
  return {width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, level)};
}

using io_test::error_of;

class Video : public testing::Test {
 public:
  Video() { fs::create_directories(folder_ / "bin"); }
  ~Video() override { setenv("PATH", path_.c_str(), 1); }

  /// Replaces `ffmpeg` by a shell script; `$out` is its output file.
  void stand_in(const std::string& script) const {
    const fs::path name = folder_ / "bin" / "ffmpeg";
    std::ofstream(name) << "#!/bin/sh\nfor out; do :; done; out=${out#file:}\n" << script << "\n";
    fs::permissions(name, fs::perms::owner_all);
    setenv("PATH", (folder_ / "bin").string().append(":").append(path_).c_str(), 1);
  }
  void no_ffmpeg() const { setenv("PATH", (folder_ / "bin").c_str(), 1); }

  [[nodiscard]] bool is_alone(const std::string& name) const {
    std::vector<std::string> names = folder_.names();
    std::erase(names, "bin");
    return names == (name.empty() ? std::vector<std::string>{} : std::vector{name});
  }

 protected:
  std::string path_ = std::getenv("PATH");
  io_test::TemporaryDirectory folder_;
};

TEST_F(Video, FfmpegGetsAllPicturesInOrder) {
  stand_in("cat > \"$out\"");
  VideoWriter video(folder_ / "a.mp4", 5, 3, 25);
  for (std::uint8_t level = 0; level < 40; ++level) video.add(grey(5, 3, level));
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
  video.finish();
  ASSERT_EQ(fs::file_size(folder_ / "a.mp4"), 40u * 5 * 3 * 4);
  std::ifstream bytes(folder_ / "a.mp4", std::ios::binary);
  for (int level = 0; level < 40; ++level) {
    for (int i = 0; i < 5 * 3 * 4; ++i) ASSERT_EQ(bytes.get(), level);
  }
  EXPECT_TRUE(is_alone("a.mp4"));
}

TEST_F(Video, WithoutFfmpegTheErrorNamesThePackage) {
  no_ffmpeg();
  const std::string message =
      error_of([&] { const VideoWriter video(folder_ / "a.mp4", 4, 4, 25); });
  EXPECT_NE(message.find("ffmpeg: is not installed"), std::string::npos) << message;
  EXPECT_NE(message.find("Debian package ffmpeg"), std::string::npos) << message;
  EXPECT_TRUE(is_alone(""));
}

TEST_F(Video, TheErrorHoldsFfmpegsMessage) {
  stand_in("cat > /dev/null; echo first complaint >&2; echo second >&2; exit 3");
  VideoWriter video(folder_ / "a.mp4", 4, 4, 25);
  video.add(grey(4, 4, 1));
  const std::string message = error_of([&] { video.finish(); });
  EXPECT_NE(message.find("a.mp4: ffmpeg failed: first complaint; second"), std::string::npos)
      << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(Video, AComplaintOfFfmpegThatExitsWith0IsAFailureAndKeepsTheOldVideo) {
  std::ofstream(folder_ / "a.mp4") << "good";
  stand_in("cat > \"$out\"; echo 'Error writing trailer: No space left on device' >&2");
  VideoWriter video(folder_ / "a.mp4", 4, 4, 25, Replace::anything);
  video.add(grey(4, 4, 1));
  const std::string message = error_of([&] { video.finish(); });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_EQ(fs::file_size(folder_ / "a.mp4"), 4U);
}

TEST_F(Video, AnUnfinishedVideoLeavesNothing) {
  stand_in("cat > \"$out\"; sleep 60");
  {
    VideoWriter video(folder_ / "a.mp4", 4, 4, 25);
    video.add(grey(4, 4, 1));
  }
  EXPECT_TRUE(is_alone(""));
}

TEST_F(Video, WrongEndingsSizesAndRatesAreErrors) {
  stand_in("cat > \"$out\"");
  const auto message = [&](const char* name, std::uint32_t width, double rate) {
    return error_of([&] { const VideoWriter video(folder_ / name, width, 4, rate); });
  };
  EXPECT_NE(message("a.avi", 4, 25).find("use .mp4, .mkv, .mov or .webm"), std::string::npos);
  EXPECT_NE(message("a.mp4", 0, 25).find("pixels"), std::string::npos);
  EXPECT_NE(message("a.mp4", 4, 0).find("0 pictures a second"), std::string::npos);
  VideoWriter video(folder_ / "a.mp4", 4, 4, 25);
  EXPECT_NE(error_of([&] { video.add(grey(4, 5, 1)); }).find("4 x 5"), std::string::npos);
  EXPECT_NE(error_of([&] { video.finish(); }).find("has no pictures"), std::string::npos);
}

}  // namespace
}  // namespace pillarfield::viewer
