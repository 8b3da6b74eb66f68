#include "io/output_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) fail();
}

void OutputFile::fail() const {
  throw Error(path_.string(), std::string("cannot be written: ") + std::strerror(errno),
              "check its directory and the space left on its disk");
}

void OutputFile::write(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

void OutputFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void OutputFile::write_at_begin(std::string_view text) {
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail();
  write(text);
}

void OutputFile::close() {
  if (std::fclose(file_.release()) != 0) fail();
}

}  // namespace pillarfield
