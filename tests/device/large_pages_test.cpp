// Memory that kernels go through once a frame.

#include "device/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

namespace pillarfield {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21U;

TEST(LargePages, BeginOnALargePageAndHoldTheRequestedBytes) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{4095}, std::size_t{4097}, kLargePage,
                                  kLargePage + 1, 3 * kLargePage}) {
    const LargePages memory = allocate_large_pages(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory.get()) % kLargePage, 0U) << bytes;
    // Sanitizers watch the ends.
    const std::span<std::byte> all(memory.get(), bytes);
    std::ranges::fill(all, std::byte{7});
    EXPECT_EQ(std::ranges::count(all, std::byte{7}), static_cast<std::ptrdiff_t>(bytes));
  }
}

TEST(LargePages, AreWholePagesToTheirEnd) {
  // The device reads up to the end of a page, beyond the requested bytes.
  const LargePages small = allocate_large_pages(1);
  std::ranges::fill(std::span(small.get(), 4096), std::byte{1});
  const LargePages large = allocate_large_pages(kLargePage + 1);
  std::ranges::fill(std::span(large.get(), 2 * kLargePage), std::byte{1});
  EXPECT_EQ(large[2 * kLargePage - 1], std::byte{1});
}

TEST(LargePages, MayBeMovedAndAreNeverShared) {
  LargePages first = allocate_large_pages(kLargePage);
  const LargePages second = allocate_large_pages(kLargePage);
  EXPECT_NE(first.get(), second.get());
  std::byte* const where = first.get();
  const LargePages moved = std::move(first);
  EXPECT_EQ(moved.get(), where);
}

}  // namespace
}  // namespace pillarfield
