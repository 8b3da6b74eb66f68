#pragma once

#include <cstddef>
#include <memory>

namespace pillarfield {

inline constexpr std::size_t kPageSize = 4096;

constexpr std::size_t page_aligned(std::size_t bytes) {
  return (bytes + kPageSize - 1) / kPageSize * kPageSize;
}

struct FreeLargePages {
  void operator()(std::byte* memory) const;
};

/// Uninitialised, page-aligned host memory.
using LargePages = std::unique_ptr<std::byte[], FreeLargePages>;

/// Memory that kernels read or write once per frame, in large pages if it fills one and the system
/// grants them: a frame's planes have more small pages than the TLB holds
/// (docs/performance_decisions.md). Throws std::bad_alloc.
LargePages allocate_large_pages(std::size_t bytes);

}  // namespace pillarfield
