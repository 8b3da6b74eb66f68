#include "io/output/replaceable.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include "io/file_kind.h"
#include "io/force_format.h"
#include "io/force_sink.h"
#include "io/hdf5/file.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace pillarfield {
namespace {

constexpr std::string_view kMcapBeginning = "\x89MCAP0\r\n";

/// Beginnings of results other than forces and contacts (SinkFormat); all other files that exist
/// need --overwrite.
struct Beginning {
  OutputKind kind;
  std::size_t offset;
  std::string_view bytes;
};
constexpr std::array<Beginning, 3> kBeginnings = {{
    {OutputKind::png, 0, "\x89PNG\r\n\x1a\n"},
    {OutputKind::video, 4, "ftyp"},              // MP4, QuickTime
    {OutputKind::video, 0, "\x1a\x45\xdf\xa3"},  // Matroska, WebM
}};

bool is_empty_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::file_size(path, error) == 0 && !error;
}

/// True if a file is an earlier result of this kind, in the format of its extension.
bool is_earlier_result(const InputFile& file, OutputKind kind) {
  const std::string head = file.text_at(0, 1024);
  if (const SinkFormat* const format = format_by_extension(file.path(), kind)) {
    return format->begins.empty() ? hdf5::format_of(file.path()) == force_format::kName
                                  : format_by_beginning(head) == format;
  }
  return std::ranges::any_of(kBeginnings, [&](const Beginning& beginning) {
    return beginning.kind == kind && head.size() > beginning.offset &&
           std::string_view(head).substr(beginning.offset).starts_with(beginning.bytes);
  });
}

/// True if a recording has frames, or cannot be read.
bool has_frames(const std::filesystem::path& recording) {
  try {
    return open_frames(recording)->frames() > 0;
  } catch (const Error&) {
    return true;
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
  if (is_earlier_result(InputFile(path), kind)) return;
  throw Error(path.string(), "exists and is not an earlier result of this kind",
              "choose another name, or replace it with --overwrite");
}

void require_disposable(const std::filesystem::path& path, Replace replace) {
  if (is_empty_file(path)) return;
  const InputFile part(path);
  const DetectedFormat detected = detect_format(part);
  const std::string head = part.text_at(0, 1024);
  bool is_ours = head.starts_with(kMcapBeginning);
  bool is_kept = is_ours || (detected.frames != nullptr && format_by_beginning(head) == nullptr);
  if (detected.kind == FileKind::hdf5) {
    const auto format = hdf5::format_of(path);  // Unset: a writer died before its first flush.
    is_kept = format && format != force_format::kName &&
              (format != recording_format::kName || has_frames(path));
    is_ours = format == recording_format::kName || format == calibration_format::kName;
  }
  if (!is_kept || (is_ours && replace == Replace::anything)) return;
  throw Error(path.string(), "holds data that no command can make again",
              is_ours ? "rename it, or replace it with --overwrite" : "rename or remove it");
}

}  // namespace pillarfield
