#pragma once

#include <cstddef>
#include <memory>

namespace pillarfield {

struct FreeLargePages {
  void operator()(std::byte* memory) const;
};

/// Memory of the host, uninitialised, on a boundary of pages.
using LargePages = std::unique_ptr<std::byte[], FreeLargePages>;

/// Memory that kernels go through once a frame: in large pages where it is worth one and the system
/// gives any, since a frame's planes otherwise need more pages than the processor has looked up
/// (docs/performance_decisions.md). Throws std::bad_alloc.
LargePages allocate_large_pages(std::size_t bytes);

}  // namespace pillarfield
