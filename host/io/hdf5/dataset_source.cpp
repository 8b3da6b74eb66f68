// Frames in HDF5 files: recordings, and datasets of other programs.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>

#include "io/frame_source.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/dataset.h"
#include "io/hdf5/readers.h"
#include "io/plain/source.h"
#include "io/recording_format.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

[[noreturn]] void ask_for_dataset(const hdf5::File& file,
                                  const std::optional<std::string>& format) {
  const std::vector<std::string> names = hdf5::list_datasets(file);
  throw Error(
      file.path.string(),
      "is an HDF5 file but not a recording: " +
          (format ? fmt::format("its format is '{:.60}'", *format)
                  : std::string("it has no attribute 'format'")),
      names.empty()
          ? "it holds no dataset of frames; to see what it holds, " +
                python_line("import h5py; h5py.File({0}).visititems(print)", file.path)
          : fmt::format("name its readings with --dataset; it has {}", fmt::join(names, ", ")));
}

}  // namespace

std::unique_ptr<FileSource> read_hdf5_frames(hdf5::File file, const ReadOptions& options) {
  const auto format = hdf5::Attributes(file).text("format");
  if (format && format->starts_with("pillarfield-")) {
    if (!options.dataset.empty() || !options.times.empty()) {
      throw Error(file.path.string(),
                  fmt::format("is a {:.60}, whose readings have their place", *format),
                  "leave out --dataset and --times");
    }
    refuse_layout(file.path, options);
    return read_recording(std::move(file), options);
  }
  if (options.dataset.empty()) ask_for_dataset(file, format);
  const auto shared = std::make_shared<const hdf5::File>(std::move(file));
  std::vector<double> times_s;
  if (!options.times.empty()) times_s = read_numbers(*hdf5::open_dataset(shared, options.times));
  return array_source(shared->path, "HDF5 dataset", hdf5::open_dataset(shared, options.dataset),
                      std::move(times_s), options);
}

}  // namespace pillarfield
