#include "io/output/replaceable.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "io/file_kind.h"
#include "io/force_format.h"
#include "io/force_sink.h"
#include "io/frame_source.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace pillarfield {
namespace {

/// Kind of a file by its content.
struct FoundContent {
  std::optional<OutputKind> kind;      ///< unset: not written by this project
  std::string words;                   ///< "holds a recording"
  const SinkFormat* format = nullptr;  ///< for forces and contacts
};

FoundContent hdf5_content(const InputFile& input) {
  const hdf5::QuietErrors quiet;
  const hdf5::File file = hdf5::open_to_read(input, false);
  const std::string format = hdf5::read_text(file, file.id.get(), "format").value_or("");
  if (format == recording_format::kName) return {OutputKind::recording, "holds a recording"};
  if (format == calibration_format::kName) return {OutputKind::calibration, "holds a calibration"};
  if (format == force_format::kName) {
    const SinkFormat* const written = format_by_extension("forces.h5", OutputKind::forces);
    return {OutputKind::forces, written->content, written};
  }
  return {std::nullopt, "is an HDF5 file of another kind"};
}

/// Signature of a picture, video or drawing.
struct Beginning {
  OutputKind kind;
  const char* words;
  std::size_t offset;
  std::string_view bytes;
};

constexpr std::array<Beginning, 5> kBeginnings = {{
    {OutputKind::messages, "holds messages", 0, "\x89MCAP0\r\n"},
    {OutputKind::png, "is a picture", 0, "\x89PNG\r\n\x1a\n"},
    {OutputKind::video, "is a video", 4, "ftyp"},              // MP4, QuickTime
    {OutputKind::video, "is a video", 0, "\x1a\x45\xdf\xa3"},  // Matroska, WebM
    {OutputKind::svg, "is a drawing", 0, "<svg"},
}};

FoundContent content_by_beginning(const InputFile& file) {
  const std::string head = file.text_at(0, 1024);
  for (const Beginning& beginning : kBeginnings) {
    if (head.size() < beginning.offset) continue;
    if (head.compare(beginning.offset, beginning.bytes.size(), beginning.bytes) == 0) {
      return {beginning.kind, beginning.words};
    }
  }
  if (const SinkFormat* const format = format_by_beginning(head)) {
    return {format->kind, format->content, format};
  }
  if (head.starts_with("<?xml") && head.find("<svg") != std::string::npos) {
    return {OutputKind::svg, "is a drawing"};
  }
  return {std::nullopt, file.path().extension() == ".toml"
                            ? "is a scene or another TOML file"
                            : "is not an earlier output of this kind"};
}

FoundContent content_of(const std::filesystem::path& path) {
  const InputFile file(path);
  const DetectedFormat detected = detect_format(file);
  if (detected.kind == FileKind::hdf5) return hdf5_content(file);
  FoundContent found = content_by_beginning(file);
  if (found.kind || detected.frames == nullptr) return found;
  return {std::nullopt, fmt::format("is a {}", detected.frames->name)};
}

bool is_empty_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::file_size(path, error) == 0 && !error;
}

bool is_result(OutputKind kind) {
  return kind != OutputKind::recording && kind != OutputKind::calibration &&
         kind != OutputKind::messages && kind != OutputKind::text;
}

constexpr const char* kKeepOrReplace = "rename it, or replace it with --overwrite";

/// Number of frames in an unfinished recording.
std::uint64_t frames_in(const std::filesystem::path& part) {
  try {
    return open_frames(part)->frames();
  } catch (const Error& error) {
    throw Error(part.string(),
                fmt::format("holds a recording that cannot be read ({})", error.what()),
                kKeepOrReplace);
  }
}

}  // namespace

void require_replaceable(const std::filesystem::path& path, OutputKind kind, Replace replace) {
  std::error_code ignored;
  const auto status = std::filesystem::symlink_status(path, ignored);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(path.string(), "exists and is not a regular file", "choose another name");
  }
  if (replace == Replace::nothing) throw Error(path.string(), "exists", "choose another name");
  if (replace == Replace::anything || is_empty_file(path)) return;
  FoundContent found;
  try {
    found = content_of(path);
  } catch (const Error&) {
    found.words = "cannot be read";
  }
  const SinkFormat* const asked = format_by_extension(path, kind);
  const bool is_of_its_format = asked == nullptr || asked == found.format;
  if (found.kind == kind && is_result(kind) && is_of_its_format) return;
  throw Error(path.string(), "exists and " + found.words,
              "choose another name, or replace it with --overwrite");
}

void require_disposable(const std::filesystem::path& path, Replace replace) {
  if (is_empty_file(path)) return;
  FoundContent found;
  try {
    found = content_of(path);
  } catch (const Error&) {
    return;  // A writer died before its first flush.
  }
  if (found.kind && replace == Replace::anything) return;
  if (found.kind == OutputKind::recording) {
    const std::uint64_t frames = frames_in(path);
    if (frames == 0) return;
    throw Error(path.string(), fmt::format("holds {} frames of an unfinished recording", frames),
                kKeepOrReplace);
  }
  const bool is_worth_keeping =
      found.kind ? !is_result(*found.kind) : kind_of(path) != FileKind::other;
  if (!is_worth_keeping) return;
  throw Error(path.string(), found.words, found.kind ? kKeepOrReplace : "rename or remove it");
}

}  // namespace pillarfield
