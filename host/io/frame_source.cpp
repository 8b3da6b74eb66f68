#include "io/frame_source.h"

#include <array>
#include <string>

#include "io/file_kind.h"
#include "io/hdf5/readers.h"
#include "pillarfield/error.h"

namespace pillarfield {

// Each is defined beside its source.
SourceFormat tekscan_format();

std::span<const SourceFormat> source_formats() {
  static const std::array formats = {tekscan_format()};
  return formats;
}

const SourceFormat* source_format(std::string_view head) {
  for (const SourceFormat& format : source_formats()) {
    if (format.recognises(head)) return &format;
  }
  return nullptr;
}

std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                         const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  const DetectedFormat detected = detect_format(path);
  if (detected.kind == FileKind::hdf5) return read_recording(open_probed(path, options));
  if (detected.frames != nullptr) return detected.frames->open(path);
  std::string known = "an HDF5 recording";
  for (const SourceFormat& format : source_formats()) known += std::string(" nor a ") + format.name;
  throw Error(path.string(), "is neither " + known, "docs/formats.md describes them");
}

}  // namespace pillarfield
