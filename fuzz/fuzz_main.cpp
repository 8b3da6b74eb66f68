// Entry point of libFuzzer: one program per target, whose function is PILLARFIELD_FUZZ_READ.
// Readers need a path, so the bytes are written to a file. Readers trust it, so
// that crashes in libhdf5 reach the fuzzer.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz/targets.h"
#include "pillarfield/error.h"

namespace {

/// A file in the directory for temporary files, ideally in memory. HDF5 cannot open files without a
/// name, as memfd_create() makes them.
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
