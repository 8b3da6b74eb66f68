#include "io/file_kind.h"
#include "io/hdf5/readers.h"
#include "io/tekscan/source.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace pillarfield {

std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                         const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  switch (kind_of(path)) {
    case FileKind::hdf5:
      return read_recording(open_probed(path, options));
    case FileKind::tekscan:
      return open_tekscan(path);
    case FileKind::other:
      break;
  }
  throw Error(path.string(), "is neither an HDF5 recording nor a Tekscan ASCII export",
              "docs/formats.md describes both");
}

}  // namespace pillarfield
