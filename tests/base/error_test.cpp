// Error: its text and the parts of it.

#include "pillarfield/error.h"

#include <gtest/gtest.h>

#include <string>

namespace pillarfield {
namespace {

std::string text_of_parts(const Error& error) {
  const auto text = [](std::string_view part) { return std::string(part); };
  return "[" + text(error.place()) + "][" + text(error.failure()) + "][" + text(error.mend()) + "]";
}

TEST(Error, PartsAreThoseOfTheText) {
  EXPECT_EQ(text_of_parts(Error("a: b", "c; d", "e: f")), "[a: b][c; d][e: f]");
  EXPECT_EQ(text_of_parts(Error("", "it failed")), "[][it failed][]");
  EXPECT_EQ(text_of_parts(Error("", "it failed", "mend it")), "[][it failed][mend it]");
  EXPECT_EQ(text_of_parts(Error("file", "")), "[file][][]");
  EXPECT_STREQ(Error("file", "it failed", "mend it").what(), "file: it failed; mend it");
}

TEST(Error, PartsArePrintable) {
  const Error error("a\nb", "\x1b[31m", "\xff");
  EXPECT_EQ(text_of_parts(error), "[a b][\\u001b[31m][\\xff]");
}

}  // namespace
}  // namespace pillarfield
