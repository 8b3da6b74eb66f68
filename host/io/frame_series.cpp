// Several files, such as one for each frame, as one source of frames.

#include "io/frame_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/file_kind.h"
#include "io/layout_note.h"
#include "io/series_files.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

bool is_digit_of_name(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }

/// Takes the digits at the beginning of a name, without leading zeros.
std::string_view take_digits(std::string_view& name) {
  const auto end = std::ranges::find_if_not(name, is_digit_of_name);
  std::string_view digits = name.substr(0, static_cast<std::size_t>(end - name.begin()));
  name.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Whether a name comes before another, numbers in them by their value.
bool comes_before(const std::filesystem::path& one, const std::filesystem::path& other) {
  std::string_view a = one.native();
  std::string_view b = other.native();
  while (!a.empty() && !b.empty()) {
    if (is_digit_of_name(a.front()) && is_digit_of_name(b.front())) {
      const std::string_view x = take_digits(a);
      const std::string_view y = take_digits(b);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.empty() && b.empty() ? one < other : a.empty();
}

void add_files_of(const std::filesystem::path& folder, std::vector<std::filesystem::path>& files) {
  std::error_code failure;
  std::filesystem::directory_iterator entries(folder, failure);
  if (failure) throw Error(folder.string(), failure.message(), "check its permissions");
  std::map<std::string, std::size_t> kinds;
  const std::size_t before = files.size();
  for (const auto& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (name.front() == '.' || name == "metadata.yaml" || !entry.is_regular_file(failure)) continue;
    files.push_back(entry.path());
    ++kinds[extension_of(entry.path())];
  }
  if (files.size() == before) {
    throw Error(folder.string(), "is a folder without files of frames", "name a file of frames");
  }
  if (kinds.size() == 1) return;
  std::string found;
  for (const auto& [extension, count] : kinds) {
    if (found.size() > 60) break;
    found += fmt::format("{}{} {:.20}", found.empty() ? "" : ", ", count,
                         extension.empty() ? "without ending" : extension);
  }
  const auto most = std::ranges::max_element(
      kinds, {}, [](const auto& kind) { return std::pair(kind.second, !kind.first.empty()); });
  throw Error(folder.string(), fmt::format("holds files of several kinds: {}", found),
              fmt::format("name those of the frames: {}/*{:.20}", folder.string(), most->first));
}

class FrameSeries final : public FileSource {
 public:
  FrameSeries(std::vector<std::filesystem::path> files, const ReadOptions& options, OpenFile open);

  double time(std::uint64_t index) override;
  double read(std::uint64_t index, FrameBuffer& frame) override;
  [[nodiscard]] bool has_truth() const override { return has_truth_; }
  void read_truth(std::uint64_t index, ForceField& truth) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  void take_first();
  void check_member(const FileSource& member) const;
  /// The open file that holds a frame, and the frame's index in it.
  std::pair<FileSource&, std::uint64_t> place_of(std::uint64_t index);

  std::vector<std::filesystem::path> files_;
  ReadOptions options_;
  OpenFile open_file_;
  std::vector<std::uint64_t> ends_;  // of the frames of each file
  std::vector<double> times_s_;      // empty: see assumed_time()
  std::unique_ptr<FileSource> open_;
  std::size_t open_index_ = 0;
  bool has_truth_ = true;
  std::optional<FrameBuffer> narrow_;  // a frame of a file whose type is another
};

FrameSeries::FrameSeries(std::vector<std::filesystem::path> files, const ReadOptions& options,
                         OpenFile open)
    : FileSource(files.front(), ""),
      files_(std::move(files)),
      options_(options),
      open_file_(std::move(open)) {
  options_.untimed = true;
  options_.rate_hz.reset();
  bool is_timed = true;
  bool is_mixed = false;
  for (open_index_ = 0; open_index_ < files_.size(); ++open_index_) {
    open_ = open_file_(files_[open_index_], options_);
    if (open_index_ == 0) take_first();
    check_member(*open_);
    has_truth_ = has_truth_ && open_->has_truth();
    is_timed = is_timed && open_->states_times();
    for (std::uint64_t i = 0; is_timed && i < open_->frames(); ++i) {
      times_s_.push_back(open_->time(i));
    }
    is_mixed = is_mixed || open_->sensel_type() != type_;
    frames_ += open_->frames();
    ends_.push_back(frames_);
  }
  --open_index_;
  if (is_mixed && skin_.falling) {
    throw Error(path_.string(), "and later files differ in the type of their readings",
                "store one type, so that falling readings can be mirrored");
  }
  if (is_mixed) type_ = SenselType::f32;
  if (!is_timed) times_s_.clear();
  times_s_.empty() ? assume_times(options) : settle_times(times_s_, options);
}

void FrameSeries::take_first() {
  format_ = "series of " + open_->format();
  skin_ = open_->skin();
  type_ = open_->sensel_type();
  calibration_ = open_->calibration();
  warnings_ = open_->warnings();
}

void FrameSeries::check_member(const FileSource& member) const {
  const auto refuse = [&](const std::string& what) {
    throw Error(files_[open_index_].string(),
                fmt::format("{} than {}", what, files_.front().filename().string()),
                "name files of one array and one shape, or give -o a folder: one result each");
  };
  const Skin& skin = member.skin();
  if (skin.rows != skin_.rows || skin.cols != skin_.cols) {
    refuse(fmt::format("its frames are {} x {}, of another size", skin.rows, skin.cols));
  }
  const auto constants = [](const Skin& of) {
    return std::array{
        of.sensel_pitch_mm.row_mm, of.sensel_pitch_mm.col_mm,        of.counts_per_newton,
        of.threshold_counts,       of.full_scale_counts.value_or(0), of.has_pillars() ? 1.0 : 0.0,
        of.falling ? 1.0 : 0.0};
  };
  if (constants(skin) != constants(skin_)) refuse("has other constants of the skin");
  const Calibration& planes = member.calibration();
  if (planes.tare != calibration_.tare || planes.gain != calibration_.gain ||
      planes.dead_zone != calibration_.dead_zone || planes.mask != calibration_.mask) {
    refuse("has another calibration");
  }
}

std::pair<FileSource&, std::uint64_t> FrameSeries::place_of(std::uint64_t index) {
  require_frame(index);
  const auto file =
      static_cast<std::size_t>(std::ranges::upper_bound(ends_, index) - ends_.begin());
  if (file != open_index_ || !open_) {
    open_.reset();
    open_ = open_file_(files_[file], options_);
    open_index_ = file;
    check_member(*open_);
  }
  return {*open_, index - (file == 0 ? 0 : ends_[file - 1])};
}

double FrameSeries::time(std::uint64_t index) {
  require_frame(index);
  return times_s_.empty() ? assumed_time(index) : times_s_[index];
}

double FrameSeries::read(std::uint64_t index, FrameBuffer& frame) {
  require_fitting(frame);
  const auto [member, at] = place_of(index);
  if (member.sensel_type() == type_) {
    member.read(at, frame);
    return time(index);
  }
  if (!narrow_ || narrow_->view().type != member.sensel_type()) {
    narrow_.emplace(member.sensel_type(), skin_.rows, skin_.cols);
  }
  member.read(at, *narrow_);
  const auto floats = frame.readings<float>().begin();
  if (member.sensel_type() == SenselType::u8) {
    std::ranges::copy(narrow_->readings<std::uint8_t>(), floats);
  } else {
    std::ranges::copy(narrow_->readings<std::uint16_t>(), floats);
  }
  return time(index);
}

void FrameSeries::read_truth(std::uint64_t index, ForceField& truth) {
  const auto [member, at] = place_of(index);
  member.read_truth(at, truth);
}

std::vector<std::string> FrameSeries::notes() const {
  std::vector<std::string> notes = {
      fmt::format("Read {} files, from {} to {}: {} frames of {} x {}, {}; {}.", files_.size(),
                  files_.front().filename().string(), files_.back().filename().string(), frames_,
                  skin_.rows, skin_.cols, name_of(type_), layout_note(skin_))};
  notes.insert(notes.end(), notes_.begin(), notes_.end());
  return notes;
}

}  // namespace

std::vector<std::filesystem::path> series_files(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : paths) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
      add_files_of(path, files);
    } else {
      files.push_back(path);
    }
  }
  if (files.empty()) throw Error("frames", "no file is named", "name one, several or a folder");
  std::ranges::sort(files, comes_before);
  return files;
}

std::unique_ptr<FileSource> frame_series(std::vector<std::filesystem::path> files,
                                         const ReadOptions& options, OpenFile open) {
  return std::make_unique<FrameSeries>(std::move(files), options, std::move(open));
}

}  // namespace pillarfield
