// Texts from files are safe to print on a terminal.

#include "pillarfield/printable.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "base/utf8.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

TEST(Printable, LeavesTextAlone) {
  for (const char* text : {"", "A ball", "α ± 2°, 猫 🐾", R"(back\slash "quoted")"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, EscapesTerminalControls) {
  EXPECT_EQ(printable("\x1b[31mred\x1b]0;title\x07"), "\\u001b[31mred\\u001b]0;title\\u0007");
  EXPECT_EQ(printable("a\nb\r\tc\x7f"), "a\\nb\\r\\tc\\u007f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\u009b2J"), "\\u009b2J");          // CSI as one character
  EXPECT_EQ(printable("a\u202egpj.b"), "a\\u202egpj.b");  // right to left from here
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("i\xffn"), "i\\xffn");
  EXPECT_EQ(printable("\x9b"), "\\x9b");           // CSI in Latin-1
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");  // the same, too long by a byte
  EXPECT_EQ(printable("\xe0\x82\x9b"), "\\xe0\\x82\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a pair of UTF-16
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");  // cut off
}

TEST(Printable, AnyBytesBecomeALineOfUtf8) {
  std::mt19937_64 random(4);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string bytes(random() % 12, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::string line = printable(bytes);
    EXPECT_TRUE(is_utf8(line)) << line;
    for (const char character : line) {
      const auto code = static_cast<unsigned char>(character);
      EXPECT_TRUE(code >= 0x20 && code != 0x7f) << line;
    }
    EXPECT_EQ(printable(line), line);
  }
}

}  // namespace
}  // namespace pillarfield
