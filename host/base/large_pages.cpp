#include "base/large_pages.h"

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace pillarfield {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21U;  ///< bytes, on x86 and mostly on ARM
constexpr std::align_val_t kAlignment{kLargePage};

std::size_t whole_pages(std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  const std::size_t page = bytes < kLargePage ? kPage : kLargePage;
  return (bytes + page - 1) / page * page;
}

}  // namespace

void FreeLargePages::operator()(std::byte* memory) const {
  ::operator delete[](memory, kAlignment);
}

LargePages allocate_large_pages(std::size_t bytes) {
  const std::size_t size = whole_pages(bytes);
  LargePages memory(static_cast<std::byte*>(::operator new[](size, kAlignment)));
#ifdef MADV_HUGEPAGE
  // The system may refuse the advice; the memory is then only slower.
  if (size >= kLargePage) static_cast<void>(madvise(memory.get(), size, MADV_HUGEPAGE));
#endif
  return memory;
}

}  // namespace pillarfield
