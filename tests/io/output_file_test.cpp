// Outputs: locked parts, replacement of files, and writes to the disk.

#include "pillarfield/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdlib>
#include <functional>
#include <utility>

#include "pillarfield/calibration_file.h"
#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace {

/// System calls of the library in order: "file", "folder" (fsync), "rename".
std::vector<std::string>& disk_calls() {
  static std::vector<std::string> calls;
  return calls;
}

int note_sync(int descriptor, long number) {
  struct stat found = {};
  fstat(descriptor, &found);
  disk_calls().emplace_back(S_ISDIR(found.st_mode) ? "folder" : "file");
  return static_cast<int>(syscall(number, descriptor));
}

/// Called once, between the opening of a part and its lock.
std::function<void()>& before_lock() {
  static std::function<void()> action;
  return action;
}

}  // namespace

// These replace functions of the C library.
extern "C" {
int noted_fcntl(int descriptor, int command, ...) asm("fcntl");
int noted_fsync(int descriptor) asm("fsync");
int noted_fdatasync(int descriptor) asm("fdatasync");
int noted_rename(const char* from, const char* to) asm("rename");
int noted_renameat2(int from_folder, const char* from, int to_folder, const char* to,
                    unsigned flags) asm("renameat2");

int noted_fcntl(int descriptor, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (command == F_OFD_SETLK && before_lock()) std::exchange(before_lock(), nullptr)();
  return static_cast<int>(syscall(SYS_fcntl, descriptor, command, argument));
}
int noted_fsync(int descriptor) { return note_sync(descriptor, SYS_fsync); }
int noted_fdatasync(int descriptor) { return note_sync(descriptor, SYS_fdatasync); }
int noted_rename(const char* from, const char* to) {
  disk_calls().emplace_back("rename");
  return static_cast<int>(syscall(SYS_renameat, AT_FDCWD, from, AT_FDCWD, to));
}
int noted_renameat2(int from_folder, const char* from, int to_folder, const char* to,
                    unsigned flags) {
  disk_calls().emplace_back("rename");
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
}

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;
using Names = std::vector<std::string>;
namespace fs = std::filesystem;

constexpr const char* kTableHead = "frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status\n";

Skin small_skin() {
  Skin skin;
  skin.rows = skin.cols = 4;
  return skin;
}

RecordingWriter begin_recording(const fs::path& path, Replace replace = Replace::results) {
  return RecordingWriter(path, small_skin(), SenselType::u8, {}, {.replace = replace});
}

void write_recording(const fs::path& path, std::uint64_t frames, bool finish = true) {
  RecordingWriter writer = begin_recording(path, Replace::anything);
  const FrameBuffer frame(SenselType::u8, 4, 4);
  for (std::uint64_t index = 0; index < frames; ++index) {
    writer.append(frame.view(), static_cast<double>(index));
  }
  if (finish) writer.finish();
}

void write_some_forces(const fs::path& path, std::uint64_t frames,
                       Replace replace = Replace::results) {
  const auto sink =
      create_force_sink(path, {2, 2, 1.25, "direct", "a device", "it", false}, replace);
  for (std::uint64_t index = 0; index < frames; ++index) {
    const ForceField forces = sample_forces(index, 2, 2);
    sink->append({.forces = forces.view(), .time_s = static_cast<double>(index)});
  }
  sink->finish();
}

SkinCalibration small_calibration() {
  SkinCalibration calibration;
  calibration.rows = calibration.cols = 4;
  return calibration;
}

void write_text(const fs::path& path, const std::string& text, Replace replace) {
  OutputFile file(path, OutputKind::forces, replace);
  file.write(text);
  file.commit();
}

TEST(OutputFile, TakesItsNameWhenItIsComplete) {
  const TemporaryDirectory directory;
  OutputFile file(directory / "a.csv", OutputKind::forces);
  EXPECT_EQ(directory.names(), Names{"a.csv.part"});
  file.write("one ");
  file.write("two");
  file.write_at_begin("O");
  file.commit();
  EXPECT_EQ(directory.names(), Names{"a.csv"});
  EXPECT_EQ(bytes_of(directory / "a.csv"), "One two");
  EXPECT_TRUE(has_all(error_of([&] { file.write("three"); }), {"a.csv", "is finished"}));
}

TEST(OutputFile, IsRemovedUnlessItIsKept) {
  const TemporaryDirectory directory;
  { OutputFile(directory / "a.csv", OutputKind::forces).write("lost"); }
  EXPECT_EQ(directory.names(), Names{});
  {
    OutputFile file(directory / "a.csv", OutputKind::forces);
    file.write("kept");
    file.keep();
  }
  EXPECT_EQ(bytes_of(directory / "a.csv.part"), "kept");
}

TEST(OutputFile, ASecondWriterEndsAndTheFirstWritesOn) {
  const TemporaryDirectory directory;
  OutputFile first(directory / "a.csv", OutputKind::forces);
  first.write("first");
  fs::create_symlink("a.csv", directory / "link.csv");
  for (const char* name : {"a.csv", "link.csv"}) {
    const std::string error = error_of([&] { OutputFile(directory / name, OutputKind::forces); });
    EXPECT_TRUE(has_all(error, {"a.csv: is being written by another process", "wait"})) << error;
  }
  EXPECT_EQ(bytes_of(directory / "a.csv.part"), "first") << "truncated before it was locked";
  EXPECT_TRUE(
      has_all(error_of([&] {
                check_outputs({}, {{directory / "a.csv", OutputKind::forces}}, Replace::anything);
              }),
              {"is being written"}));
  first.commit();
  EXPECT_EQ(bytes_of(directory / "a.csv"), "first");
}

TEST(OutputFile, ItsLockEndsWithAKilledProcess) {
  const TemporaryDirectory directory;
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(directory / "a.csv", OutputKind::forces);
    file.write("half");
    if (::write(ready[1], "!", 1) != 1) _exit(1);
    pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  close(ready[0]);
  close(ready[1]);
  EXPECT_TRUE(has_all(error_of([&] { OutputFile(directory / "a.csv", OutputKind::forces); }),
                      {"is being written"}));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(bytes_of(directory / "a.csv.part"), "half");
  write_text(directory / "a.csv", "whole", Replace::results);
  EXPECT_EQ(bytes_of(directory / "a.csv"), "whole");
}

TEST(OutputFile, APartThatTakesItsNameBeforeTheLockIsLeftAlone) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.csv.part", "finished");
  before_lock() = [&] { fs::rename(directory / "a.csv.part", directory / "a.csv"); };
  OutputFile file(directory / "a.csv", OutputKind::forces, Replace::anything);
  EXPECT_FALSE(before_lock());
  EXPECT_EQ(bytes_of(directory / "a.csv"), "finished");
  file.write("next");
  EXPECT_EQ(bytes_of(directory / "a.csv"), "finished");
  file.commit();
  EXPECT_EQ(bytes_of(directory / "a.csv"), "next");
}

TEST(OutputFile, APartThatIsALinkIsRefused) {
  const TemporaryDirectory directory;
  write_bytes(directory / "victim", "precious");
  const auto refusal = [&] {
    const std::string checked = error_of([&] {
      check_outputs({}, {{directory / "a.csv", OutputKind::forces}}, Replace::anything);
    });
    std::string opened =
        error_of([&] { OutputFile(directory / "a.csv", OutputKind::forces, Replace::anything); });
    EXPECT_EQ(checked, opened);
    fs::remove(directory / "a.csv.part");
    EXPECT_EQ(bytes_of(directory / "victim"), "precious");
    return opened;
  };
  fs::create_symlink(directory / "victim", directory / "a.csv.part");
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part: is a symbolic link", "remove it"}));
  fs::create_symlink(directory / "absent", directory / "a.csv.part");
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part: is a symbolic link"}));
  fs::create_hard_link(directory / "victim", directory / "a.csv.part");
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part", "several names"}));
  ASSERT_EQ(mkfifo((directory / "a.csv.part").c_str(), 0600), 0);
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part", "not a regular file"}));
}

TEST(OutputFile, LeftoversThatCannotBeMadeAgainAreKept) {
  const TemporaryDirectory directory;
  const auto refusal = [&] {
    const std::string before = bytes_of(directory / "a.csv.part");
    std::string error =
        error_of([&] { OutputFile(directory / "a.csv", OutputKind::forces, Replace::results); });
    EXPECT_EQ(bytes_of(directory / "a.csv.part"), before);
    return error;
  };
  write_recording(directory / "a.csv", 3, false);
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part", "holds data", "rename it", "--overwrite"}));
  const PlannedOutput planned = {directory / "a.csv", OutputKind::forces};
  EXPECT_NE(error_of([&] { check_outputs({}, {planned}, Replace::results); }), "");
  check_outputs({}, {planned}, Replace::anything);
  write_text(directory / "a.csv", "as asked", Replace::anything);
  EXPECT_EQ(directory.names(), Names{"a.csv"});
  fs::remove(directory / "a.csv");
  write_calibration_file(directory / "a.csv.part", small_calibration());
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part", "holds data"}));
  write_bytes(directory / "a.csv.part", "DATA_TYPE MOVIE\nROWS 4\nCOLS 4\n");
  EXPECT_TRUE(has_all(refusal(), {"a.csv.part", "holds data", "remove it"}));
  fs::remove(directory / "a.csv.part");
  write_some_forces(directory / "f.h5", 20);
  fs::rename(directory / "f.h5", directory / "a.csv.part");
  write_text(directory / "a.csv", "forces can be solved again", Replace::results);
  EXPECT_EQ(directory.names(), Names{"a.csv"});
}

TEST(OutputFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  const TemporaryDirectory directory;
  for (const fs::perms mode : {fs::perms{0600}, fs::perms{0444}, fs::perms{0664}}) {
    write_text(directory / "a.csv", "before", Replace::anything);
    fs::permissions(directory / "a.csv", mode);
    OutputFile file(directory / "a.csv", OutputKind::forces, Replace::anything);
    EXPECT_EQ(fs::status(directory / "a.csv.part").permissions(), mode | fs::perms{0600});
    file.commit();
    EXPECT_EQ(fs::status(directory / "a.csv").permissions(), mode);
  }
}

TEST(OutputFile, AFileCreatedMeanwhileIsNotReplaced) {
  const TemporaryDirectory directory;
  RecordingWriter writer = begin_recording(directory / "r.h5");
  writer.append(FrameBuffer(SenselType::u8, 4, 4).view(), 0);
  write_bytes(directory / "r.h5", "precious");
  const std::string error = error_of([&] { writer.finish(); });
  EXPECT_TRUE(has_all(error, {"r.h5", "exists", "the data are complete in", "r.h5.part"}));
  EXPECT_EQ(bytes_of(directory / "r.h5"), "precious");
  EXPECT_EQ(open_frames(directory / "r.h5.part")->frames(), 1u);
}

TEST(OutputFile, ARemovedPartIsReported) {
  const TemporaryDirectory directory;
  OutputFile file(directory / "a.csv", OutputKind::forces);
  fs::remove(directory / "a.csv.part");
  write_bytes(directory / "a.csv.part", "of somebody else");
  const std::string error = error_of([&] { file.commit(); });
  EXPECT_TRUE(has_all(error, {"a.csv.part", "renamed or removed"}));
  EXPECT_EQ(error.find("complete in"), std::string::npos);
  EXPECT_FALSE(fs::exists(directory / "a.csv"));
  EXPECT_EQ(bytes_of(directory / "a.csv.part"), "of somebody else");
}

TEST(OutputFile, ALinkAtItsNameStaysAndItsTargetIsWritten) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "far");
  fs::create_symlink("far/b.csv", directory / "a.csv");
  write_text(directory / "a.csv", kTableHead, Replace::results);
  EXPECT_TRUE(fs::is_symlink(directory / "a.csv"));
  EXPECT_EQ(bytes_of(directory / "far/b.csv"), kTableHead);
  write_recording(directory / "far/b.csv", 1);
  EXPECT_TRUE(has_all(error_of([&] { write_text(directory / "a.csv", "", Replace::results); }),
                      {"far/b.csv", "not an earlier result"}));
  fs::create_symlink("loop", directory / "loop");
  EXPECT_NE(error_of([&] { write_text(directory / "loop", "", Replace::anything); }), "");
}

TEST(OutputFile, IsOnTheDiskBeforeItHasItsNameAndItsFolderAfter) {
  const TemporaryDirectory directory;
  const Names expected = {"file", "rename", "folder"};
  const auto calls_of = [](auto&& action) {
    disk_calls().clear();
    action();
    return disk_calls();
  };
  EXPECT_EQ(calls_of([&] { write_text(directory / "a.csv", "", Replace::results); }), expected);
  EXPECT_EQ(calls_of([&] { write_recording(directory / "r.h5", 20); }), expected);
  EXPECT_EQ(calls_of([&] { write_recording(directory / "r.h5", 20); }), expected);
  EXPECT_EQ(calls_of([&] { write_some_forces(directory / "f.h5", 20); }), expected);
  EXPECT_EQ(calls_of([&] { write_some_forces(directory / "f.npy", 20); }), expected);
  EXPECT_EQ(calls_of([&] { write_calibration_file(directory / "c.h5", small_calibration()); }),
            expected);
}

TEST(OutputFile, APartThatGrowsIsWrittenToTheDiskAtIntervals) {
  const TemporaryDirectory directory;
  OutputFile file(directory / "a.csv", OutputKind::forces);
  disk_calls().clear();
  file.sync_at_intervals();
  file.sync_at_intervals(std::chrono::hours(1));
  EXPECT_EQ(disk_calls(), Names{}) << "too soon";
  file.sync_at_intervals(std::chrono::seconds(0));
  file.commit();  // waits for it
  EXPECT_EQ(disk_calls(), (Names{"file", "file", "rename", "folder"}));
}

TEST(CheckOutputs, TwoOutputsNeverShareAFile) {
  const TemporaryDirectory directory;
  fs::create_symlink("a.csv", directory / "link.csv");
  for (const char* other : {"a.csv", "./a.csv", "link.csv", "a.csv.part"}) {
    const std::string error = error_of([&] {
      check_outputs(
          {},
          {{directory / "a.csv", OutputKind::forces}, {directory / other, OutputKind::contacts}},
          Replace::anything);
    });
    EXPECT_TRUE(has_all(error, {"cannot share this file"}));
  }
  check_outputs(
      {}, {{directory / "a.csv", OutputKind::forces}, {directory / "b.csv", OutputKind::contacts}},
      Replace::results);
  EXPECT_TRUE(name_same_file(directory / "a.csv", directory / "link.csv"));
  EXPECT_FALSE(name_same_file(directory / "a.csv", directory / "b.csv"));
}

TEST(CheckOutputs, AnInputIsNeverWrittenByWhateverName) {
  const TemporaryDirectory directory;
  write_bytes(directory / "in.h5", "precious");
  write_bytes(directory / "new.h5.part", "precious");
  fs::create_symlink("in.h5", directory / "soft.h5");
  fs::create_hard_link(directory / "in.h5", directory / "hard.h5");
  fs::create_symlink(".", directory / "here");
  for (const char* input : {"in.h5", "soft.h5", "hard.h5", "new.h5.part"}) {
    const bool is_part = std::string_view(input) == "new.h5.part";
    for (const std::string output : {"in.h5", "soft.h5", "hard.h5", "here/in.h5"}) {
      const PlannedOutput planned = {directory / (is_part ? "new.h5" : output), OutputKind::forces};
      EXPECT_TRUE(has_all(
          error_of([&] { check_outputs({directory / input}, {planned}, Replace::anything); }),
          {"read", "write to another file"}));
    }
  }
}

TEST(CheckOutputs, UnwritablePathsAreRefused) {
  const TemporaryDirectory directory;
  const auto refused = [&](const fs::path& path) {
    return error_of([&] { check_outputs({}, {{path, OutputKind::png}}, Replace::anything); });
  };
  EXPECT_TRUE(has_all(refused(directory / "none" / "a.png"), {"none/a.png", "No such file"}));
  EXPECT_TRUE(has_all(refused("/dev/null"), {"/dev/null", "not a regular file"}));
  EXPECT_TRUE(has_all(refused("-"), {"standard output"}));
  EXPECT_TRUE(has_all(refused(""), {"empty"}));
  EXPECT_EQ(directory.names(), Names{});
}

}  // namespace
}  // namespace pillarfield
