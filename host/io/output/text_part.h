#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// A text file that is written in large blocks to its part.
class TextPart {
 public:
  TextPart(const std::filesystem::path& path, OutputKind kind, Replace replace);

  void write(std::string_view text);

  /// Writes the buffered rest and renames the part.
  void finish();

  /// Throws Error after finish().
  void require_open() const;

 private:
  OutputFile file_;
  fmt::memory_buffer text_;
};

}  // namespace pillarfield
