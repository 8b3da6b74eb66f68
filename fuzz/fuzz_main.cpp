// The entry point of libFuzzer: one program for each target, PILLARFIELD_FUZZ_READ being its
// function. The readers take a path, so the bytes become a file in memory. They trust it: crashes
// within libhdf5 end the fuzzer's process, and thousands of files a second need no child process
// each.

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "fuzz/targets.h"
#include "pillarfield/error.h"

namespace {

class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size)
      : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || write(descriptor_, data, size) != static_cast<ssize_t>(size)) {
      std::abort();
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const {
    return fmt::format("/proc/self/fd/{}", descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  try {
    pillarfield::fuzz::PILLARFIELD_FUZZ_READ(file.path(), {.trust = true});
  } catch (const pillarfield::Error&) {  // NOLINT(bugprone-empty-catch): the expected outcome
  }
  return 0;
}
