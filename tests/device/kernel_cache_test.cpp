// Directories for compiled kernels, which are loaded as code.

#include "device/kernel_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/base/message.h"

namespace pillarfield {
namespace {

namespace fs = std::filesystem;

constexpr uid_t kNobody = 65534;

/// Chooses a directory in a separate environment and folder.
class KernelCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = "/tmp/pillarfield-test-XXXXXX";
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    for (const char* variable : {"POCL_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR"}) {
      unsetenv(variable);
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A directory in the test's folder with these rights, whatever the mask.
  [[nodiscard]] fs::path directory(const char* name, mode_t mode) const {
    fs::path path = folder_ / name;
    mkdir(path.c_str(), mode);
    chmod(path.c_str(), mode);
    return path;
  }

  static void set(const char* variable, const fs::path& value) {
    setenv(variable, value.c_str(), 1);
  }

  KernelCache choose() { return choose_kernel_cache(temporary_); }

  /// Expects a temporary directory with a reason that contains `why`.
  void expect_temporary(const std::string& why) {
    const KernelCache cache = choose();
    ASSERT_NE(temporary_, nullptr) << cache.directory;
    EXPECT_EQ(cache.directory, temporary_->directory().path);
    EXPECT_NE(cache.not_kept.find(why), std::string::npos) << cache.not_kept;
    struct stat facts {};
    ASSERT_EQ(stat(cache.directory.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777U, 0700U);
    EXPECT_EQ(facts.st_uid, geteuid());
    temporary_.reset();
    EXPECT_FALSE(fs::exists(cache.directory));
  }

  /// Expects the user's directory to be refused in one line that contains `why`.
  void expect_refused(const fs::path& asked_for, const std::string& why) {
    set("POCL_CACHE_DIR", asked_for);
    const std::string message = core_test::message_of([&] { choose(); });
    EXPECT_TRUE(message.starts_with("POCL_CACHE_DIR: ")) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_EQ(temporary_, nullptr);
  }

  fs::path folder_;
  std::unique_ptr<TemporaryDirectory> temporary_;
};

TEST_F(KernelCacheTest, MissingDirectoriesAreCreatedForThisUserAlone) {
  const mode_t before = umask(0);
  for (const char* variable : {"HOME", "XDG_CACHE_HOME"}) {  // The second goes before the first.
    set(variable, folder_ / variable);
    const KernelCache cache = choose();
    const fs::path caches = folder_ / variable / (variable == std::string("HOME") ? ".cache" : "");
    EXPECT_EQ(cache.directory, caches / "pillarfield/kernels");
    EXPECT_EQ(cache.not_kept, "");
    for (fs::path made = cache.directory; made != folder_; made = made.parent_path()) {
      struct stat facts {};
      ASSERT_EQ(stat(made.c_str(), &facts), 0);
      EXPECT_EQ(facts.st_mode & 0777U, 0700U) << made;
    }
  }
  umask(before);
  set("POCL_CACHE_DIR", folder_ / "mine/of old");
  EXPECT_EQ(choose().directory, folder_ / "mine/of old");
}

TEST_F(KernelCacheTest, WithoutAHomeItIsNotKept) {
  expect_temporary("HOME and XDG_CACHE_HOME are not set");
  set("HOME", "relative/home");
  expect_temporary("not set");
  EXPECT_FALSE(fs::exists("relative"));
  set("HOME", "/proc/nope");
  expect_temporary("/proc/nope cannot be made");
  set("TMPDIR", directory("mine", 0700));
  EXPECT_EQ(choose().directory.parent_path(), folder_ / "mine");
}

TEST_F(KernelCacheTest, DirectoriesThatOthersCanWriteAreSkipped) {
  set("XDG_CACHE_HOME", directory("writable", 0777));
  expect_temporary("others can write " + (folder_ / "writable").string());

  const fs::path home = directory("home", 0755);
  set("HOME", home);  // The next choice.
  EXPECT_EQ(choose().directory, home / ".cache/pillarfield/kernels");

  chmod((home / ".cache").c_str(), 0777);
  expect_temporary("others can write " + (home / ".cache").string());
  chmod((home / ".cache").c_str(), 0700);
  chmod((home / ".cache/pillarfield/kernels").c_str(), 01777);
  expect_temporary("others can write");
}

TEST_F(KernelCacheTest, LinksAreResolvedFirst) {
  const fs::path writable = directory("writable", 0777);
  const fs::path home = directory("home", 0755);
  fs::create_directory_symlink(writable, home / ".cache");
  set("HOME", home);
  expect_temporary("others can write " + writable.string());
  fs::remove(home / ".cache");
  fs::create_directory_symlink(directory("mine", 0700), home / ".cache");
  EXPECT_EQ(choose().directory, folder_ / "mine/pillarfield/kernels");
}

TEST_F(KernelCacheTest, InAStickyDirectoryOnesOwnIsSafe) {
  set("POCL_CACHE_DIR", directory("sticky", 01777) / "mine");
  EXPECT_EQ(choose().directory, folder_ / "sticky/mine");
  expect_refused(folder_ / "sticky", "others can write");
}

TEST_F(KernelCacheTest, DirectoriesOfOthersAreSkipped) {
  const fs::path theirs = directory("theirs", 0755);
  if (chown(theirs.c_str(), kNobody, kNobody) != 0) GTEST_SKIP() << "only root gives files away";
  set("HOME", theirs);
  expect_temporary("belongs to another user");
  expect_refused(theirs / "kernels", "belongs to another user");
}

TEST_F(KernelCacheTest, TheUsersDirectoryIsUsedOrRefused) {
  expect_refused(directory("writable", 0777), "others can write");
  expect_refused(directory("shared", 0770), "others can write");
  std::ofstream(folder_ / "file") << "text";
  expect_refused(folder_ / "file", "is not a directory");
  expect_refused(folder_ / "file/below", "");
  expect_refused("/proc/nope", "/proc/nope cannot be made");
  fs::current_path(directory("here", 0700));
  set("POCL_CACHE_DIR", "kernels");
  EXPECT_EQ(choose().directory, folder_ / "here/kernels");
  fs::current_path("/");
}

TEST_F(KernelCacheTest, AFullDiskIsReported) {
  const PrivateDirectory found = private_directory(folder_ / "kernels", UINTMAX_MAX);
  EXPECT_TRUE(found.path.empty());
  EXPECT_NE(found.refused.find("KiB left"), std::string::npos) << found.refused;
}

TEST_F(KernelCacheTest, AForkedProcessLeavesTheDirectoryAlone) {
  const KernelCache cache = choose();
  const pid_t child = fork();
  if (child == 0) {
    temporary_.reset();
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(fs::exists(cache.directory));
}

}  // namespace
}  // namespace pillarfield
