// Writers that die: by SIGKILL at any time, or of a full disk.

#include <fcntl.h>
#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "pillarfield/force_file.h"
#include "pillarfield/recording.h"
#include "tests/io/damage.h"
#include "tests/io/sample_contacts.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

using Names = std::vector<std::string>;

/// A running writer_process.
class Writer {
 public:
  explicit Writer(std::vector<std::string> arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) std::abort();
    child_ = fork();
    if (child_ == 0) run(std::move(arguments), ends[1]);
    close(ends[1]);
    said_ = fdopen(ends[0], "r");
  }
  ~Writer() { std::fclose(said_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Reads the next line that it prints; false at the end.
  bool hear(std::string& line) {
    char text[1024];
    if (std::fgets(text, sizeof text, said_) == nullptr) return false;
    line = text;
    return true;
  }

  void kill_it() const { kill(child_, SIGKILL); }

  /// Waits for its end. Returns the exit status, or minus the signal.
  [[nodiscard]] int status() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  [[noreturn]] static void run(std::vector<std::string> arguments, int output) {
    dup2(output, STDOUT_FILENO);
    std::vector<char*> words = {const_cast<char*>(PILLARFIELD_WRITER_PROCESS)};
    for (auto& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }

  pid_t child_ = -1;
  std::FILE* said_ = nullptr;
};

/// Runs a writer, kills it some time after it has flushed `after` frames, and returns the number of
/// frames that it has certainly flushed.
std::uint64_t flushed_by_killed(const std::string& kind, const std::filesystem::path& path,
                                const std::string& size, std::uint64_t after,
                                std::uint64_t pause_us) {
  Writer writer({kind, path.string(), size, size, "1000000000"});
  std::string line;
  std::uint64_t flushed = 0;
  while (flushed < after && writer.hear(line)) flushed = std::stoull(line);
  usleep(static_cast<useconds_t>(pause_us));
  writer.kill_it();
  while (writer.hear(line)) flushed = std::stoull(line);
  EXPECT_EQ(writer.status(), -SIGKILL);
  return flushed;
}

/// Checks that every frame in the file is the one that the writer process wrote, raw and truth.
void expect_written_frames(FrameSource& source, std::uint64_t first = 0) {
  const Skin& skin = source.skin();
  FrameBuffer expected(SenselType::u16, skin.rows, skin.cols);
  FrameBuffer read(SenselType::u16, skin.rows, skin.cols);
  ForceField truth;
  for (std::uint64_t index = first; index < source.frames(); ++index) {
    fill_frame(index, expected);
    ASSERT_EQ(source.read(index, read), 0.25 * static_cast<double>(index));
    ASSERT_TRUE(std::ranges::equal(read.bytes(), expected.bytes())) << "frame " << index;
    source.read_truth(index, truth);
    const ForceField written = sample_forces(index, truth.rows, truth.cols);
    ASSERT_EQ(truth.normal, written.normal);
    ASSERT_EQ(truth.shear_x, written.shear_x);
  }
}

void expect_written_frames(const ForceFileReader& reader) {
  ForceField forces;
  for (std::uint64_t index = 0; index < reader.frames(); ++index) {
    ASSERT_EQ(reader.read(index, forces), 0.25 * static_cast<double>(index));
    const ForceField expected = sample_forces(index, forces.rows, forces.cols);
    ASSERT_EQ(forces.shear_x, expected.shear_x) << "frame " << index;
    ASSERT_EQ(forces.shear_y, expected.shear_y);
    ASSERT_EQ(forces.normal, expected.normal);
    ASSERT_EQ(forces.status, expected.status);
  }
}

/// Small frames share a chunk, large ones have one each; kills come at various times.
TEST(KilledRecording, GivesEveryFlushedFrame) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    const TemporaryDirectory directory;
    const auto path = directory / "r.h5";
    const std::string size = trial % 3 == 2 ? "300" : trial % 3 == 1 ? "20" : "1";
    const std::uint64_t flushed =
        flushed_by_killed("recording", path, size, 1 + 10 * trial, number_at(trial, 0) % 3000);
    EXPECT_EQ(directory.names(), Names{"r.h5.part"});
    const std::string before = bytes_of(directory / "r.h5.part");
    const auto source = open_frames(directory / "r.h5.part");
    EXPECT_GE(source->frames(), flushed);
    ASSERT_FALSE(source->warnings().empty());
    EXPECT_TRUE(has_all(source->warnings()[0], {"not closed"}));
    expect_written_frames(*source);
    EXPECT_TRUE(bytes_of(directory / "r.h5.part") == before) << "changed by reading";
  }
}

TEST(KilledRecording, CutOrChangedNeverGivesWrongReadingsOrCrashes) {
  const TemporaryDirectory directory;
  flushed_by_killed("recording", directory / "r.h5", "20", 200, 0);
  read_cut(directory / "cut.h5", bytes_of(directory / "r.h5.part"), 25,
           [](const auto& path) { expect_written_frames(*open_frames(path)); });
  flushed_by_killed("recording", directory / "s.h5", "1", 20, 0);
  read_changed(directory / "broken.h5", bytes_of(directory / "s.h5.part"), 30,
               [](const auto& path) {
                 const auto source = open_frames(path);
                 FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
                 if (source->frames() > 0) source->read(0, frame);
               });
}

TEST(UnfinishedRecording, IsReadWhileItIsWritten) {
  const TemporaryDirectory directory;
  Writer writer({"recording", (directory / "r.h5").string(), "20", "20", "1000000000"});
  std::string line;
  for (int times = 0; times < 8 && writer.hear(line); ++times) {
    const std::uint64_t flushed = std::stoull(line);
    const auto source = open_frames(directory / "r.h5.part");
    EXPECT_GE(source->frames(), flushed);
    expect_written_frames(*source, source->frames() - std::min<std::uint64_t>(flushed, 20));
  }
  writer.kill_it();
  EXPECT_EQ(writer.status(), -SIGKILL);
}

TEST(KilledForces, GiveEveryFlushedFrame) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    const TemporaryDirectory directory;
    const std::string size = trial % 3 == 2 ? "300" : trial % 3 == 1 ? "20" : "1";
    const std::uint64_t flushed = flushed_by_killed("forces", directory / "f.h5", size,
                                                    16 + 32 * trial, number_at(trial, 1) % 3000);
    const ForceFileReader reader(directory / "f.h5.part");
    EXPECT_GE(reader.frames(), flushed);
    ASSERT_EQ(reader.warnings().size(), 1u);
    expect_written_frames(reader);
  }
}

/// Tiles that nothing touches are not stored; those that the cut took are not taken for them.
TEST(KilledForces, CutNeverGiveWrongForces) {
  const TemporaryDirectory directory;
  flushed_by_killed("forces", directory / "f.h5", "20", 200, 0);
  read_cut(directory / "cut.h5", bytes_of(directory / "f.h5.part"), 25,
           [](const auto& path) { expect_written_frames(ForceFileReader(path)); });
}

TEST(KilledForces, GiveTheContactsOfEveryFlushedFrame) {
  for (std::uint64_t trial = 0; trial < 3; ++trial) {
    const TemporaryDirectory directory;
    const std::string size = trial % 2 == 1 ? "20" : "1";
    const std::uint64_t flushed = flushed_by_killed("contacts", directory / "f.h5", size,
                                                    16 + 32 * trial, number_at(trial, 1) % 3000);
    const ForceFileReader reader(directory / "f.h5.part");
    EXPECT_GE(reader.frames(), flushed);
    for (std::uint64_t index = 0; index < reader.frames(); ++index) {
      ASSERT_EQ(io_test::written_out(reader.read_contacts(index)),
                io_test::written_out(io_test::sample_contacts(index)))
          << index;
    }
  }
}

herr_t expect_within_page(hid_t, const char* name, const H5O_info_t* object, void* checked) {
  if (object->hdr.nchunks > 1) return 0;  // the places of the others are unknown
  EXPECT_LE(object->addr % 4096 + object->hdr.space.total, 4096u) << name;
  ++*static_cast<int*>(checked);
  return 0;
}

/// A killed process leaves whole pages of a call: half a header would make the file unreadable.
TEST(KilledForces, FindNoHeaderAcrossPages) {
  const TemporaryDirectory directory;
  ForceFileInfo info = {3, 4, 1.25, "direct", "a device", "it", false};
  info.contacts.emplace();
  create_force_sink(directory / "f.h5", info)->finish();
  const hid_t file = H5Fopen((directory / "f.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  int checked = 0;
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, expect_within_page, &checked);
  H5Fclose(file);
  EXPECT_GT(checked, 30);
}

/// The last line of a writer whose file may grow to at most `limit` bytes.
std::string last_words(const std::string& kind, const std::filesystem::path& path,
                       std::size_t limit) {
  Writer writer({kind, path.string(), "20", "20", "5000", std::to_string(limit)});
  std::string line;
  while (writer.hear(line)) continue;
  EXPECT_EQ(writer.status(), 3) << limit;
  return line;
}

TEST(FullDisk, LeavesTheFlushedFramesOfARecording) {
  for (const std::size_t limit : {0u, 100u, 1000u, 3000u, 6000u, 60000u, 300000u, 2000000u}) {
    const TemporaryDirectory directory;
    write_bytes(directory / "r.h5", "precious");
    const std::string words = last_words("recording", directory / "r.h5", limit);
    EXPECT_TRUE(has_all(words, {"r.h5.part", "cannot be written", "File too large", "disk"}));
    EXPECT_EQ(bytes_of(directory / "r.h5"), "precious");
    if (limit < 1000000) continue;
    const auto source = open_frames(directory / "r.h5.part");
    EXPECT_GT(source->frames(), 100u);
    expect_written_frames(*source);
  }
}

TEST(FullDisk, LeavesTheFlushedFramesOfForces) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(has_all(last_words("forces", directory / "f.h5", 3000), {"f.h5", "File too large"}));
  EXPECT_EQ(directory.names(), Names{});
  EXPECT_TRUE(has_all(last_words("forces", directory / "f.h5", 2000000), {"File too large"}));
  const ForceFileReader reader(directory / "f.h5.part");
  EXPECT_GT(reader.frames(), 100u);
  expect_written_frames(reader);
}

TEST(FullDisk, LeavesNothingOfTextAndArrays) {
  const TemporaryDirectory directory;
  for (const char* name : {"f.csv", "f.npy"}) {
    for (const std::size_t limit : {0u, 200u, 100000u}) {
      const std::string words = last_words("forces", directory / name, limit);
      EXPECT_TRUE(has_all(words, {name, "cannot be written", "File too large"}));
      EXPECT_EQ(directory.names(), Names{});
    }
  }
}

}  // namespace
}  // namespace pillarfield
