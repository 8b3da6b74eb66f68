// Settings that the viewer remembers between runs.
#include "viewer/app/source/user_settings.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/io/sample_files.h"

namespace pillarfield::viewer {
namespace {

TEST(UserSettings, RememberSourcesWhateverTheFileHolds) {
  const io_test::TemporaryDirectory folder;
  setenv("XDG_CONFIG_HOME", (folder / "config").c_str(), 1);
  const std::string source = (folder / "a.h5").string();
  io_test::write_bytes(source, "");
  {
    UserSettings settings;
    settings.add_recent(source);
    settings.save();
  }
  EXPECT_EQ(UserSettings().recent(), std::vector{source});
  const std::filesystem::path file = folder / "config" / "pillarfield" / "viewer.conf";
  std::string noise = "box\nrecent\npanel\n";
  for (std::uint64_t i = 0; i < 3000; ++i) noise += static_cast<char>(io_test::number_at(1, i));
  io_test::write_bytes(file, noise + "\nbox 20 30 pillars 1 4 2 9 a\nrecent " + source + "\n");
  EXPECT_EQ(UserSettings().recent(), std::vector{source});
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  UserSettings().save();
  EXPECT_TRUE(std::filesystem::is_directory(file));
  unsetenv("XDG_CONFIG_HOME");
}

}  // namespace
}  // namespace pillarfield::viewer
