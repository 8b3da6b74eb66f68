// Detection of a file's kind by its content, also while it is renamed.

#include "io/file_kind.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <stop_token>
#include <string>
#include <thread>

#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

const std::string kSignature = "\x89HDF\r\n\x1a\n";

TEST(FileKind, FollowsFromTheContent) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a", kSignature + std::string(100, 'x'));
  write_bytes(directory / "b", std::string(1024, 'u') + kSignature);  // after a user block
  write_bytes(directory / "c", std::string(1000, 'u') + kSignature);  // at an invalid offset
  write_bytes(directory / "d",
              "\xef\xbb\xbf"
              "DATA_TYPE MOVIE\r\n");
  write_bytes(directory / "e", "ROWS 2\nASCII_DATA @@\n");
  write_bytes(directory / "f", "MY DATA_TYPE\n");
  EXPECT_EQ(kind_of(directory / "a"), FileKind::hdf5);
  EXPECT_EQ(kind_of(directory / "b"), FileKind::hdf5);
  EXPECT_EQ(kind_of(directory / "c"), FileKind::other);
  EXPECT_EQ(kind_of(directory / "d"), FileKind::frames);
  EXPECT_EQ(kind_of(directory / "e"), FileKind::frames);
  EXPECT_EQ(kind_of(directory / "f"), FileKind::other);
}

TEST(FileKind, OtherFormatsAreNamedWithALineOfPython) {
  const TemporaryDirectory directory;
  struct Case {
    std::string bytes;
    const char* name;
    const char* code;
  };
  using namespace std::string_literals;
  for (const Case& each : {
           Case{"\xff\xd8\xff\xe0"s, "JPEG", "Image.open"},
           Case{"PAR1"s, "Parquet", "read_parquet"},
           Case{"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"s, "XLS", "read_excel"},
           Case{"\x1f\x8b\x08"s, "gzip", "gzip.open"},
           Case{R"({"frames": [[1, 2], [3, 4]]})"s, "JSON", "json.load"},
           Case{"#ROSBAG V2.0\n"s, "ROS 1", "rosbags"},
       }) {
    SCOPED_TRACE(each.name);
    write_bytes(directory / "file.bin", each.bytes + std::string(40, ' '));
    const std::string error =
        error_of([&] { static_cast<void>(open_frames(directory / "file.bin")); });
    EXPECT_TRUE(has_all(error, {"is not read; run python3 -c", each.name, each.code})) << error;
  }
  write_bytes(directory / "it's.p", "\x80\x04\x95");
  EXPECT_TRUE(has_all(error_of([&] { static_cast<void>(open_frames(directory / "it's.p")); }),
                      {"open('FILE', 'rb')"}));
  std::filesystem::create_directory(directory / "store.zarr");
  write_bytes(directory / "store.zarr" / ".zgroup", "{}");
  EXPECT_TRUE(has_all(error_of([&] { static_cast<void>(open_frames(directory / "store.zarr")); }),
                      {"Zarr", "zarr.open"}));
}

/// A pipe without a writer would block who opens it.
TEST(FileKind, AFileThatBecomesAPipeIsRefusedAtOnce) {
  const TemporaryDirectory directory;
  const auto here = directory / "here";
  const auto file = directory / "file";
  const auto pipe = directory / "pipe";
  Skin skin;
  skin.rows = skin.cols = 4;
  RecordingWriter(file, skin, SenselType::u8, {}, {}).finish();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_hard_link(file, here);
  const auto next = directory / "next";
  // It does not allocate: under AddressSanitizer a child forked meanwhile would wait for ever.
  const std::jthread swapping([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      for (const char* target : {pipe.c_str(), file.c_str()}) {
        EXPECT_EQ(link(target, next.c_str()), 0);
        EXPECT_EQ(std::rename(next.c_str(), here.c_str()), 0);
        unlink(next.c_str());  // rename() leaves both names of one file.
      }
    }
  });
  int opened = 0;
  for (int i = 0; i < 20000; ++i) {
    try {
      opened += kind_of(here) == FileKind::hdf5 ? 1 : 0;
      if (i % 1000 == 0) static_cast<void>(open_frames(here));
    } catch (const Error& error) {
      EXPECT_TRUE(has_all(error.what(), {"here: is not a regular file"}));
    }
  }
  EXPECT_GT(opened, 0);
}

}  // namespace
}  // namespace pillarfield
