// Files that grow while shown.

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/growing_file.h"

namespace pillarfield::viewer {
namespace {

using io_test::fill_frame;
using io_test::sample_forces;
using io_test::TemporaryDirectory;
using io_test::write_bytes;

/// Waits until the file's time stamp distinguishes two writes.
void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(40)); }

TEST(GrowingFile, ReportsEachChangeOnce) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.h5";
  write_bytes(path, "1");
  settle();
  GrowingFile file(path);
  EXPECT_FALSE(file.may_have_changed());
  write_bytes(path, "12");
  settle();
  EXPECT_TRUE(file.may_have_changed());
  EXPECT_FALSE(file.may_have_changed());
  std::filesystem::remove(path);
  EXPECT_FALSE(file.may_have_changed()) << "a file that is away is nothing new";
}

TEST(GrowingFile, APartGoesOnUnderItsFinalName) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.h5.part", "1");
  GrowingFile file(directory / "a.h5.part");
  std::filesystem::rename(directory / "a.h5.part", directory / "a.h5");
  write_bytes(directory / "a.h5", "12");
  EXPECT_TRUE(file.may_have_changed());
  EXPECT_EQ(file.path(), directory / "a.h5");
}

void write_forces(const std::filesystem::path& path, std::uint64_t frames, std::uint32_t cols) {
  const auto sink = create_force_sink(path, {8, cols, 1.3, "direct", "", "", false, false});
  for (std::uint64_t index = 0; index < frames; ++index) {
    const ForceField forces = sample_forces(index, 8, cols);
    sink->append({.forces = forces.view(), .time_s = 0.01 * static_cast<double>(index)});
  }
  sink->finish();
}

TEST(GrowingSource, AChangedForceFileIsReadAgain) {
  const TemporaryDirectory directory;
  const auto path = directory / "f.h5";
  write_forces(path, 3, 9);
  const auto producer = open_producer(path, {});
  EXPECT_FALSE(producer->refresh());
  write_forces(path, 7, 9);
  EXPECT_TRUE(producer->refresh());
  EXPECT_FALSE(producer->refresh());
  EXPECT_EQ(producer->info().frames, 7U);
  EXPECT_EQ(producer->produce(6).forces.normal[5], sample_forces(6, 8, 9).normal[5]);
  write_forces(path, 7, 10);
  EXPECT_FALSE(producer->refresh());
  EXPECT_THROW(static_cast<void>(producer->produce(0)), Error) << "another skin";
}

/// A process that writes frames of fill_frame(), or of sample_forces().
class Writer {
 public:
  Writer(const std::string& kind, const std::filesystem::path& path, int frames)
      : pipe_(popen((std::string(PILLARFIELD_WRITER_PROCESS) + " " + kind + " " + path.string() +
                     " 40 40 " + std::to_string(frames))
                        .c_str(),
                    "r")) {}
  ~Writer() { pclose(pipe_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Waits until the process reports a flush or ends.
  void wait_for_flush() {
    char line[64];
    EXPECT_NE(std::fgets(line, sizeof line, pipe_), nullptr);
  }

 private:
  FILE* pipe_;
};

void expect_written(const ShownField& field) {
  FrameBuffer frame(SenselType::u16, 80, 80);
  if (field.raw.data == nullptr) {
    const ForceField expected = sample_forces(field.index, 40, 40);
    EXPECT_TRUE(std::ranges::equal(field.forces.normal, expected.normal)) << field.index;
    return;
  }
  fill_frame(field.index, frame);
  const auto* const raw = static_cast<const std::byte*>(field.raw.data);
  EXPECT_TRUE(std::ranges::equal(std::span(raw, frame.bytes().size()), frame.bytes()))
      << field.index;
}

/// Follows a writer to its last frame, across the final renaming of its file.
void expect_followed(const std::string& kind) {
  constexpr int kFrames = 3000;
  const TemporaryDirectory directory;
  const auto path = directory / (kind + ".h5");
  Writer writer(kind, path, kFrames);
  writer.wait_for_flush();
  std::unique_ptr<FieldProducer> producer;
  GrowingFile file(directory / (kind + ".h5.part"));  // It may have finished already.
  ASSERT_TRUE(file.reopen([&](const auto& by_now) { producer = open_producer(by_now, {}); }));
  while (true) {
    const std::uint64_t frames = producer->info().frames;
    expect_written(producer->produce(frames - 1));
    if (frames == kFrames) break;
    while (!producer->refresh()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_GT(producer->info().frames, frames);
  }
  expect_written(producer->produce(0));
}

TEST(GrowingSource, ARecordingIsFollowedWhileItIsWritten) { expect_followed("recording"); }
TEST(GrowingSource, ForcesAreFollowedWhileTheyAreSolved) { expect_followed("forces"); }

}  // namespace
}  // namespace pillarfield::viewer
