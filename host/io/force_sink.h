#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "pillarfield/force_file.h"

namespace pillarfield {

/// A file format of solved frames, defined beside its sink and listed in force_sink.cpp.
struct SinkFormat {
  OutputKind kind = OutputKind::forces;        ///< or `contacts`
  std::array<std::string_view, 2> extensions;  ///< in lower case; the second may be empty
  const char* content = "";                    ///< for messages: "is a table of forces"
  std::string_view begins = {};                ///< its first bytes; empty for HDF5
  std::string_view holds = {};                 ///< what its first 1024 bytes hold besides
  /// Creates the sink. ForceFileInfo::contacts enables contacts; sinks of contacts require it.
  std::unique_ptr<ForceSink> (*create)(const std::filesystem::path& path, const ForceFileInfo& info,
                                       Replace replace) = nullptr;
};

/// SinkFormat::create for a class with this constructor.
template <class Sink>
[[nodiscard]] std::unique_ptr<ForceSink> create_sink(const std::filesystem::path& path,
                                                     const ForceFileInfo& info, Replace replace) {
  return std::make_unique<Sink>(path, info, replace);
}

/// The format of this kind by the extension of `path`; null if there is none.
[[nodiscard]] const SinkFormat* format_by_extension(const std::filesystem::path& path,
                                                    OutputKind kind);

/// The format of a text or NPY file by its first 1024 bytes; null if unknown.
[[nodiscard]] const SinkFormat* format_by_beginning(std::string_view head);

/// Throws Error, naming `where`, unless the frame has the size and planes of `info`, contacts if
/// `info` enables them, and a finite time.
void check(const SolvedFrame& frame, const ForceFileInfo& info, const std::string& where);

/// The contacts of a frame. Throws Error, naming `where`, if it has none or its time is not finite.
[[nodiscard]] const FrameContacts& contacts_of(const SolvedFrame& frame, const std::string& where);

}  // namespace pillarfield
