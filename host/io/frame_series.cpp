// Several files, such as one for each frame, as one source of frames.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "io/file_kind.h"
#include "io/frame_source.h"
#include "pillarfield/error.h"
#include "pillarfield/layout_note.h"

namespace pillarfield {
namespace {

/// A name whose numbers are as long as the longest, so that they are sorted by value.
std::string sorted_name(const std::filesystem::path& path) {
  constexpr std::size_t kDigits = 20;
  std::string name;
  std::string digits;
  for (const char letter : path.native() + '\0') {
    if (letter >= '0' && letter <= '9') {
      digits += letter;
      continue;
    }
    if (!digits.empty() && digits.size() < kDigits) name.append(kDigits - digits.size(), '0');
    name += std::exchange(digits, {}) + letter;
  }
  return name;
}

void add_files_of(const std::filesystem::path& folder, std::vector<std::filesystem::path>& files) {
  std::map<std::string, std::size_t> kinds;  // endings, and how many files have each
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::string name = entry.path().filename().string();
    if (name.front() == '.' || name == "metadata.yaml" || !entry.is_regular_file(failure)) continue;
    files.push_back(entry.path());
    ++kinds[extension_of(entry.path())];
  }
  if (kinds.empty()) {
    throw Error(folder.string(), "is a folder without files of frames", "name a file of frames");
  }
  if (kinds.size() == 1) return;
  const auto most =
      std::ranges::max_element(kinds, {}, [](const auto& kind) { return kind.second; });
  throw Error(folder.string(),
              fmt::format("holds files of {} kinds, {} of them {:.20}", kinds.size(), most->second,
                          most->first),
              fmt::format("name those of the frames: {}/*{:.20}", folder.string(), most->first));
}

/// Has one of its files open at a time.
class FrameSeries final : public FileSource {
 public:
  FrameSeries(std::vector<std::filesystem::path> files, const ReadOptions& options)
      : FileSource(files.front(), ""), files_(std::move(files)), options_(options) {
    options_.untimed = true;
    options_.rate_hz.reset();
    bool is_timed = true;
    bool is_mixed = false;
    for (const std::filesystem::path& file : files_) {
      open(file);
      is_timed = is_timed && open_->states_times();
      for (std::uint64_t i = 0; is_timed && i < open_->frames(); ++i) {
        times_s_.push_back(open_->time(i));
      }
      is_mixed = is_mixed || open_->sensel_type() != type_;
      frames_ += open_->frames();
      ends_.push_back(frames_);
    }
    if (is_mixed && skin_.falling) {
      throw Error(path_.string(), "and later files differ in type",
                  "store one, as they are falling");
    }
    if (is_mixed) type_ = SenselType::f32;
    open_index_ = files_.size() - 1;
    if (!is_timed) times_s_.clear();
    times_s_.empty() ? assume_times(options) : settle_times(times_s_, options);
    if (!skin_.falling) note_absent();
  }

  double time(std::uint64_t index) override {
    require_frame(index);
    return times_s_.empty() ? assumed_time(index) : times_s_[index];
  }

  double read(std::uint64_t index, FrameBuffer& frame) override {
    require_frame(index);
    require_fitting(frame);
    const auto file =
        static_cast<std::size_t>(std::ranges::upper_bound(ends_, index) - ends_.begin());
    if (file != open_index_) open(files_[file]);
    open_index_ = file;
    const std::uint64_t at = index - (file == 0 ? 0 : ends_[file - 1]);
    const SenselType type = open_->sensel_type();
    if (type == type_) return open_->read(at, frame), time(index);
    FrameBuffer narrow(type, skin_.rows, skin_.cols);
    open_->read(at, narrow);
    const auto floats = frame.readings<float>().begin();
    if (type == SenselType::u8) std::ranges::copy(narrow.readings<std::uint8_t>(), floats);
    if (type == SenselType::u16) std::ranges::copy(narrow.readings<std::uint16_t>(), floats);
    return time(index);
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> notes = {
        fmt::format("Read {} files, from {} to {}: {} frames of {} x {}, {}; {}.", files_.size(),
                    files_.front().filename().string(), files_.back().filename().string(), frames_,
                    skin_.rows, skin_.cols, name_of(type_), layout_note(skin_))};
    notes.insert(notes.end(), notes_.begin(), notes_.end());
    return notes;
  }

 private:
  /// Opens a file, and takes its skin if it is the first. Throws Error if it differs from that.
  void open(const std::filesystem::path& file) {
    open_.reset();
    open_ = open_source(file, options_);
    const Skin& skin = open_->skin();
    const Calibration& planes = open_->calibration();
    if (ends_.empty()) {
      format_ = "series of " + open_->format();
      skin_ = skin;
      type_ = open_->sensel_type();
      calibration_ = planes;
      warnings_ = open_->warnings();
    }
    const auto constants = [](const Skin& of) {
      return std::tuple(of.sensel_pitch_mm.row_mm, of.sensel_pitch_mm.col_mm, of.counts_per_newton,
                        of.threshold_counts, of.full_scale_counts, of.layout, of.falling);
    };
    if (skin.rows == skin_.rows && skin.cols == skin_.cols && constants(skin) == constants(skin_) &&
        planes.tare == calibration_.tare && planes.gain == calibration_.gain &&
        planes.dead_zone == calibration_.dead_zone) {
      return;
    }
    throw Error(
        file.string(),
        fmt::format("has frames of {} x {} and its constants, {} of {} x {} and others", skin.rows,
                    skin.cols, files_.front().filename().string(), skin_.rows, skin_.cols),
        "name files of one array, or give -o a folder: one result each");
  }

  std::vector<std::filesystem::path> files_;
  ReadOptions options_;
  std::vector<std::uint64_t> ends_;  // of the frames of each file
  std::vector<double> times_s_;      // empty: see assumed_time()
  std::unique_ptr<FileSource> open_;
  std::size_t open_index_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> series_files(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : paths) {
    std::error_code ignored;
    std::filesystem::is_directory(path, ignored) ? add_files_of(path, files)
                                                 : files.push_back(path);
  }
  std::ranges::sort(files, {}, sorted_name);
  return files;
}

std::unique_ptr<FileSource> frame_series(std::vector<std::filesystem::path> files,
                                         const ReadOptions& options) {
  return std::make_unique<FrameSeries>(std::move(files), options);
}

}  // namespace pillarfield
