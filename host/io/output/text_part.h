#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// A text file that is written in large blocks under its name and ".part".
class TextPart {
 public:
  TextPart(const std::filesystem::path& path, OutputKind kind, Replace replace);

  void write(std::string_view text);

  /// Writes the rest and gives the file its name.
  void finish();

  /// Throws Error where it is finished.
  void require_open() const;

 private:
  OutputFile file_;
  fmt::memory_buffer text_;
};

}  // namespace pillarfield
