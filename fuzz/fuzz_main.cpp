// The entry point of libFuzzer: one program for each target, PILLARFIELD_FUZZ_READ being its
// function. The readers take a path, so the bytes become a file. They trust it: crashes
// within libhdf5 end the fuzzer's process, and thousands of files a second need no child process
// each.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz/targets.h"
#include "pillarfield/error.h"

namespace {

/// A file of the directory for temporary files, which should lie in memory. HDF5 opens no file that
/// has no name, as those of memfd_create().
class TemporaryFile {
 public:
  TemporaryFile(const std::uint8_t* data, std::size_t size)
      : path_(std::filesystem::temp_directory_path() / "fuzz-XXXXXX") {
    const int descriptor = mkstemp(path_.data());
    if (descriptor < 0 || write(descriptor, data, size) != static_cast<ssize_t>(size)) {
      std::abort();
    }
    close(descriptor);
  }
  ~TemporaryFile() { unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const TemporaryFile file(data, size);
  try {
    pillarfield::fuzz::PILLARFIELD_FUZZ_READ(file.path(), {.trust = true});
  } catch (const pillarfield::Error&) {  // NOLINT(bugprone-empty-catch): the expected outcome
  }
  return 0;
}
