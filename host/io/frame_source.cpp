#include "io/frame_source.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/file_kind.h"
#include "io/hdf5/crash_guard.h"
#include "io/hdf5/readers.h"
#include "io/proposal.h"
#include "pillarfield/error.h"
#include "pillarfield/frame_stream.h"

namespace pillarfield {

// Each is defined beside its source.
SourceFormat tekscan_format();
SourceFormat npy_format();
SourceFormat npz_format();
SourceFormat table_format();
SourceFormat sections_format();

std::unique_ptr<FileSource> open_source(const std::filesystem::path& path,
                                        const ReadOptions& options) {
  const InputFile file(path);
  const DetectedFormat detected = detect_format(file);
  if (detected.kind == FileKind::hdf5) {
    return read_hdf5_frames(hdf5::open_to_read(file, options.trust), options);
  }
  if (detected.frames != nullptr) {
    const Opener open = [&](const ReadOptions& with) { return detected.frames->open(path, with); };
    try {
      return open(options);
    } catch (const ProposingError& error) {
      throw settled(error, open);
    }
  }
  if (path.extension() == ".toml") {
    throw Error(path.string(), "is a scene, and this needs frames",
                fmt::format("simulate it first: pillarfield simulate {0} -o {1}.h5", path.string(),
                            path.stem().string()));
  }
  refuse_foreign(path, file.text_at(0, 4096));
  std::string known = "an HDF5 recording";
  for (const SourceFormat& format : source_formats()) known += std::string(" nor a ") + format.name;
  throw Error(path.string(), "is neither " + known, "docs/formats.md describes them");
}

std::span<const SourceFormat> source_formats() {
  static const std::array formats = {tekscan_format(), npy_format(), npz_format(), table_format(),
                                     sections_format()};
  return formats;
}

const SourceFormat* source_format(std::string_view head) {
  for (const SourceFormat& format : source_formats()) {
    if (format.recognises(head)) return &format;
  }
  return nullptr;
}

void refuse_dataset(const std::filesystem::path& path, const ReadOptions& options) {
  if (options.dataset.empty() && options.times.empty()) return;
  throw Error(path.string(), "has no named arrays",
              options.dataset.empty() ? "leave out --times" : "leave out --dataset");
}

void refuse_layout(const std::filesystem::path& path, const ReadOptions& options) {
  if (!options.readings.empty() && options.readings != "counts")
    throw Error(path.string(), "states what its readings are", "leave out --readings");
  if (!options.frame_size && options.axes.empty() && options.columns.empty() &&
      options.where.empty())
    return;
  throw Error(path.string(), "states the size and the axes of its frames",
              options.frame_size         ? "leave out --shape"
              : !options.axes.empty()    ? "leave out --axes"
              : !options.columns.empty() ? "leave out --columns"
                                         : "leave out --where");
}

std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& path,
                                         const ReadOptions& options) {
  return open_frames(std::vector{path}, options);
}

std::unique_ptr<FrameSource> open_frames(const std::vector<std::filesystem::path>& paths,
                                         const ReadOptions& options) {
  const hdf5::QuietErrors quiet;
  const hdf5::CrashGuard guard(paths.empty() ? "" : paths.front(), options.trust,
                               hdf5::CrashGuard::kNoLimit);
  for (const std::filesystem::path& path : paths) refuse_foreign(path, "");
  std::vector<std::filesystem::path> files = series_files(paths);
  std::unique_ptr<FileSource> source = files.size() == 1 ? open_source(files.front(), options)
                                                         : frame_series(std::move(files), options);
  if (options.tare_frames > 0) source->measure_tare(options);
  return source;
}

const Calibration& FrameStream::calibration() const {
  static const Calibration none;
  return none;
}

StreamHealth FrameStream::health() const { return {}; }

}  // namespace pillarfield
