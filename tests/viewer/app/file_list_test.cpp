// The list of files of the start page.
#include "viewer/app/source/file_list.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/io/sample_files.h"

namespace pillarfield::viewer {
namespace {

namespace fs = std::filesystem;

/// Two folders and files of many kinds.
struct Files {
  Files() {
    for (const char* name : {"Skins", "today", ".hidden"}) fs::create_directory(directory / name);
    for (const char* name : {"touch.h5", "a scene.toml", "B.NPY", "notes.md", ".secret.h5"}) {
      io_test::write_bytes(directory / name, "123");
    }
    io_test::write_bytes(directory / "CMakeLists.txt", "project(demo)\n");
    io_test::write_bytes(directory / "table.txt", "1 2 3 4\n5 6 7 8\n");
    io_test::write_bytes(directory / "today" / "forces.h5", "");
  }
  io_test::TemporaryDirectory directory;
  [[nodiscard]] fs::path root() const { return fs::canonical(directory / ""); }
};

std::vector<std::string> names_of(const FileList& list) {
  std::vector<std::string> names;
  for (const FileList::Entry& entry : list.entries()) names.push_back(entry.name);
  return names;
}

std::optional<fs::path> press(FileList& list, int key) {
  return list.take(KeyEvent{key, {}, true, false});
}

using Names = std::vector<std::string>;

TEST(FileList, HasFoldersAndWhatTheViewerOpens) {
  const Files files;
  FileList list(files.root());
  EXPECT_EQ(names_of(list),
            (Names{"..", "Skins", "today", "a scene.toml", "B.NPY", "table.txt", "touch.h5"}));
  EXPECT_EQ(list.entries()[3].bytes, 3U);
}

TEST(FileList, TheKeyboardFindsAFile) {
  const Files files;
  FileList list(files.root());
  EXPECT_FALSE(press(list, GLFW_KEY_DOWN));
  EXPECT_FALSE(press(list, GLFW_KEY_DOWN));
  EXPECT_FALSE(press(list, GLFW_KEY_ENTER));
  EXPECT_EQ(list.folder(), files.root() / "today");
  press(list, GLFW_KEY_END);
  EXPECT_EQ(press(list, GLFW_KEY_ENTER), files.root() / "today/forces.h5");
  press(list, GLFW_KEY_BACKSPACE);
  EXPECT_EQ(list.folder(), files.root());
  EXPECT_EQ(list.entries()[list.marked()].name, "today");
  for (const auto& [letter, name] :
       {std::pair('t', "table.txt"), std::pair('T', "touch.h5"), std::pair('t', "today")}) {
    list.take(TextEvent{static_cast<std::uint32_t>(letter)});
    EXPECT_EQ(list.entries()[list.marked()].name, name);
  }
  press(list, GLFW_KEY_PAGE_DOWN);
  EXPECT_EQ(list.marked(), 6U);
  press(list, GLFW_KEY_HOME);
  press(list, GLFW_KEY_UP);
  EXPECT_EQ(list.marked(), 0U);
  press(list, GLFW_KEY_ENTER);  // the folder above
  EXPECT_EQ(list.folder(), files.root().parent_path());
}

TEST(FileList, AFolderThatIsGoneIsSaid) {
  const Files files;
  FileList list(files.root());
  fs::remove(files.directory / "Skins");
  EXPECT_FALSE(list.open(1));
  EXPECT_EQ(list.folder(), files.root());
  EXPECT_NE(list.failure().find("Skins"), std::string::npos);
  EXPECT_FALSE(list.open(2));
  EXPECT_TRUE(list.failure().empty());
  EXPECT_EQ(FileList(files.directory / "none").folder(), fs::current_path());
}

TEST(FileList, AtTheRootThereIsNoFolderAbove) {
  FileList list("/");
  press(list, GLFW_KEY_BACKSPACE);
  EXPECT_EQ(list.folder(), "/");
  ASSERT_FALSE(list.entries().empty());
  EXPECT_NE(list.entries().front().name, "..");
}

}  // namespace
}  // namespace pillarfield::viewer
