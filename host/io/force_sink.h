#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "pillarfield/force_file.h"

namespace pillarfield {

/// A format of files of solved frames. Each is defined beside its sink and listed in
/// force_sink.cpp.
struct SinkFormat {
  OutputKind kind = OutputKind::forces;     ///< or `contacts`
  std::array<std::string_view, 2> endings;  ///< in small letters; the second may be empty
  const char* content = "";                 ///< of such a file: "is a table of forces"
  /// Whether a file that begins so is of this format; null: HDF5, whose attributes say it.
  bool (*recognises)(std::string_view head) = nullptr;
  /// Makes the sink. Contacts are asked for in ForceFileInfo::contacts, always of a sink of
  /// contacts.
  std::unique_ptr<ForceSink> (*create)(const std::filesystem::path& path, const ForceFileInfo& info,
                                       Replace replace) = nullptr;
};

/// SinkFormat::create of a class with such a constructor.
template <class Sink>
[[nodiscard]] std::unique_ptr<ForceSink> create_sink(const std::filesystem::path& path,
                                                     const ForceFileInfo& info, Replace replace) {
  return std::make_unique<Sink>(path, info, replace);
}

/// The format of this kind that the ending of `path` names; null where there is none.
[[nodiscard]] const SinkFormat* format_by_ending(const std::filesystem::path& path,
                                                 OutputKind kind);

/// The format of a file of text or numbers, by its first 1024 bytes; null where it is none.
[[nodiscard]] const SinkFormat* format_by_beginning(std::string_view head);

/// Throws Error, its place being `where`, unless the frame is of the size and has the planes that
/// `info` names, has contacts where these are asked for, and its time is finite.
void check(const SolvedFrame& frame, const ForceFileInfo& info, const std::string& where);

/// The contacts of a frame. Throws Error, its place being `where`, where it has none or its time is
/// not finite.
[[nodiscard]] const FrameContacts& contacts_of(const SolvedFrame& frame, const std::string& where);

}  // namespace pillarfield
