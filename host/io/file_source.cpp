#include "io/file_source.h"

#include <fmt/format.h>

#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {

FileSource::FileSource(std::filesystem::path path, std::string format)
    : path_(std::move(path)), format_(std::move(format)) {}

void FileSource::read_truth(std::uint64_t, ForceField&) {
  throw Error(path_.string(), "holds no true forces", "call has_truth() first");
}

void FileSource::require_frame(std::uint64_t index) const {
  if (index < frames_) return;
  throw Error(path_.string(), fmt::format("has no frame {}", index),
              fmt::format("it holds {} frames, counted from 0", frames_));
}

void FileSource::require_fitting(const FrameBuffer& frame) const {
  const FrameView view = frame.view();
  if (view.type == type_ && view.rows == skin_.rows && view.cols == skin_.cols) return;
  throw Error(path_.string(),
              fmt::format("its frames do not fit a buffer of {} x {} {}", view.rows, view.cols,
                          name_of(view.type)),
              fmt::format("make it {} x {} {}", skin_.rows, skin_.cols, name_of(type_)));
}

void FileSource::warn_of_size() {
  if (skin_.rows % 2 != 0) {
    warnings_.push_back(
        fmt::format("The last of the {} sensel rows has no pillars; it is ignored.", skin_.rows));
  }
  if (skin_.cols % 2 != 0) {
    warnings_.push_back(fmt::format(
        "The last of the {} sensel columns has no pillars; it is ignored.", skin_.cols));
  }
  if (frames_ == 0) warnings_.push_back("The file holds no frames.");
}

}  // namespace pillarfield
