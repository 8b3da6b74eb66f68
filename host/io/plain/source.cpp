#include "io/plain/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "base/number_type.h"
#include "io/frame_source.h"
#include "io/hdf5/stored_frames.h"
#include "io/plain/stated_words.h"
#include "pillarfield/array_axes.h"
#include "pillarfield/error.h"
#include "pillarfield/layout_note.h"

namespace pillarfield {
namespace {

class ArraySource final : public FileSource {
 public:
  ArraySource(const std::filesystem::path& path, std::string format,
              std::unique_ptr<NumberArray> readings, std::vector<double> times_s,
              const ReadOptions& options);

  double time(std::uint64_t index) override;
  double read(std::uint64_t index, FrameBuffer& frame) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  void require_frame_axes();
  void take_shape(const ReadOptions& options);
  void take_as_frame();
  void take_lines(const FrameSize& size);
  void check_size(const ReadOptions& options) const;

  std::unique_ptr<NumberArray> array_;
  std::vector<double> times_s_;     // empty: see assumed_time()
  std::uint64_t slices_ = 1;        // of the array, in a frame
  std::vector<std::byte> numbers_;  // of a frame
};

ArraySource::ArraySource(const std::filesystem::path& path, std::string format,
                         std::unique_ptr<NumberArray> readings, std::vector<double> times_s,
                         const ReadOptions& options)
    : FileSource(path, std::move(format)),
      array_(std::move(readings)),
      times_s_(std::move(times_s)) {
  if (!options.columns.empty() || !options.where.empty()) {
    throw Error(array_->place(), "is not a table of columns",
                options.where.empty() ? "leave out --columns" : "leave out --where");
  }
  type_ = sensel_type_for(array_->type());
  take_shape(options);
  check_size(options);
  note_absent();
  take_constants({}, options);
  check(skin_, path.c_str());
  if (times_s_.empty()) {
    assume_times(options);
  } else {
    if (times_s_.size() != frames_) {
      throw Error(
          array_->place(),
          fmt::format("has {} and {}", counted(frames_, "frame"), counted(times_s_.size(), "time")),
          "store one time per frame");
    }
    settle_times(times_s_, options);
  }
  warn_of_size();
}

/// Throws Error for an array that has axes of components or pads; its mend saves one of frames.
void ArraySource::require_frame_axes() {
  const std::string name =
      array_->place().substr(std::min(array_->place().size(), path_.string().size() + 2));
  const std::string item = name.empty() ? "" : "['" + name + "']";
  const auto read = [&](std::uint64_t index) {
    const hdf5::QuietErrors quiet;
    std::vector<std::byte> numbers(array_->slice_bytes());
    array_->read(index, 1, numbers.data());
    return doubles_of(array_->type(), numbers);
  };
  const auto take = [&](const std::string& index) {
    const bool is_hdf5 = format_ == "HDF5 dataset";
    const std::string line = python_line(
        (is_hdf5 ? "import h5py; np.save({5}, h5py.File({0})" : "np.save({5}, np.load({0})") +
            item + index + ")",
        path_);
    return line + (array_->shape().size() == 3 && array_->shape()[0] != 3
                       ? ", and give its file with --shape ROWSxCOLS"
                       : ", and give its file");
  };
  pillarfield::require_frame_axes(array_->shape(), read, array_->place(), take);
}

void ArraySource::take_shape(const ReadOptions& options) {
  const bool is_known = !options.axes.empty() || options.frame_size;
  if (!is_known || array_->shape().size() > 3) require_frame_axes();
  if (!options.axes.empty()) array_ = in_order_of_frames(std::move(array_), options.axes);
  const std::vector<std::uint64_t>& shape = array_->shape();
  const auto& size = options.frame_size;
  const bool is_frame =
      !options.axes.empty() || (size && shape[0] == size->rows && shape.back() == size->cols);
  if (shape.size() == 3) {
    frames_ = shape[0];
    skin_.rows = static_cast<std::uint32_t>(std::min<std::uint64_t>(shape[1], kMaxSensels + 1));
    skin_.cols = static_cast<std::uint32_t>(std::min<std::uint64_t>(shape[2], kMaxSensels + 1));
  } else if (shape.size() == 2 && size && !is_frame) {
    take_lines(*size);
  } else if (shape.size() == 2) {
    frames_ = 1;
    slices_ = shape[0];
    skin_.rows = static_cast<std::uint32_t>(std::min<std::uint64_t>(shape[0], kMaxSensels + 1));
    skin_.cols = static_cast<std::uint32_t>(std::min<std::uint64_t>(shape[1], kMaxSensels + 1));
    if (!is_frame) take_as_frame();
  } else {
    throw Error(array_->place(), fmt::format("has the shape {}", text_of_shape(shape)),
                "frames need the shape (frames, rows, columns)");
  }
  if (!size || (skin_.rows == size->rows && skin_.cols == size->cols)) return;
  throw Error(array_->place(), fmt::format("its frames are {} x {}", skin_.rows, skin_.cols),
              fmt::format("leave out --shape {}x{}", size->rows, size->cols));
}

/// Takes a two-dimensional array as a frame, though nothing says so.
void ArraySource::take_as_frame() {
  const std::vector<std::uint64_t>& shape = array_->shape();
  require_likely_frame(shape[0], shape[1], array_->place());
  warnings_.push_back(fmt::format(
      "The array of {} is read as one frame; if each line is a frame, give --shape ROWSxCOLS.",
      text_of_shape(shape)));
}

/// Takes each line of a two-dimensional array as a frame.
void ArraySource::take_lines(const FrameSize& size) {
  const std::vector<std::uint64_t>& shape = array_->shape();
  if (shape[1] != std::uint64_t{size.rows} * size.cols) {
    throw Error(array_->place(),
                fmt::format("has lines of {} numbers, and a frame of {} x {} has {}", shape[1],
                            size.rows, size.cols, std::uint64_t{size.rows} * size.cols),
                "give the --shape of one frame");
  }
  frames_ = shape[0];
  skin_.rows = size.rows;
  skin_.cols = size.cols;
}

void ArraySource::check_size(const ReadOptions& options) const {
  const auto fits = [](std::uint32_t size) { return size >= 1 && size <= kMaxSensels; };
  if (!fits(skin_.rows) || !fits(skin_.cols)) {
    throw Error(array_->place(),
                fmt::format("with the shape {} has no frames of 1 to {} rows and columns",
                            text_of_shape(array_->shape()), kMaxSensels),
                "frames need the shape (frames, rows, columns)");
  }
  if (!options.trust && skin_.sensels() > hdf5::kMostUntrustedValues) {
    throw Error(array_->place(),
                fmt::format("has frames of {} sensels, more than {}", skin_.sensels(),
                            hdf5::kMostUntrustedValues),
                "read larger ones from a trusted file, with --trust-input");
  }
}

double ArraySource::time(std::uint64_t index) {
  require_frame(index);
  return times_s_.empty() ? assumed_time(index) : times_s_[index];
}

double ArraySource::read(std::uint64_t index, FrameBuffer& frame) {
  const hdf5::QuietErrors quiet;
  require_frame(index);
  require_fitting(frame);
  numbers_.resize(skin_.sensels() * array_->type().bytes);
  array_->read(index * slices_, slices_, numbers_.data());
  take_readings(array_->type(), numbers_.data(), index, frame);
  return time(index);
}

std::vector<std::string> ArraySource::notes() const {
  std::vector<std::string> notes = {fmt::format("Read {} frame{} of {} x {}, {}; {}.", frames_,
                                                frames_ == 1 ? "" : "s", skin_.rows, skin_.cols,
                                                name_of(array_->type()), layout_note(skin_))};
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  return notes;
}

}  // namespace

std::unique_ptr<FileSource> array_source(const std::filesystem::path& path, std::string format,
                                         std::unique_ptr<NumberArray> readings,
                                         std::vector<double> times_s, const ReadOptions& options) {
  const std::string place = readings->place();
  ReadOptions known = options;
  std::vector<std::string> notes;
  if (!options.readings.empty()) {
    const auto newtons = StatedWords().newtons_per_cell(std::nullopt, known, notes, place);
    if (newtons) *known.counts_per_newton /= *newtons;
  }
  auto source = std::make_unique<ArraySource>(path, std::move(format), std::move(readings),
                                              std::move(times_s), known);
  for (std::string& note : notes) source->warn(std::move(note));
  if (options.axes.empty() && !options.frame_size) require_likely_axes(*source, place);
  return source;
}

}  // namespace pillarfield
