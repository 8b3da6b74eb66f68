#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/file_source.h"
#include "io/frame_source.h"
#include "io/tekscan/parser.h"
#include "pillarfield/error.h"
#include "pillarfield/layout_note.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

/// An export in any units (docs/formats.md), read into memory as a whole.
class Tekscan final : public FileSource {
 public:
  Tekscan(const std::filesystem::path& path, const ReadOptions& options);

  double time(std::uint64_t index) override;
  double read(std::uint64_t index, FrameBuffer& frame) override;

 private:
  void take_spacing(const TekscanHeader& header, const ReadOptions& options);
  void take_counts(const TekscanHeader& header, const ReadOptions& options);
  void take_newtons(const TekscanHeader& header);
  void take_times(TekscanExport& data, const ReadOptions& options);
  void take_mask(TekscanExport& data);
  void spread_outline();
  void spread(const std::array<std::size_t, 4>& sensels);
  void warn_of_header(const TekscanHeader& header);

  CompactReadings readings_;
  std::vector<double> times_s_;
};

Tekscan::Tekscan(const std::filesystem::path& path, const ReadOptions& options)
    : FileSource(path, "Tekscan ASCII") {
  refuse_dataset(path, options);
  refuse_layout(path, options);
  if (options.falling) {
    throw Error(path.string(), "the readings of a Tekscan export rise under load",
                "leave out --falling");
  }
  TekscanExport data = parse_tekscan(path);
  readings_ = std::move(data.readings);
  type_ = readings_.type();
  frames_ = data.numbers.size();
  skin_.rows = *data.header.rows;
  skin_.cols = *data.header.cols;
  skin_.layout = options.layout.value_or(SkinLayout::sensels);
  take_spacing(data.header, options);
  if (data.header.is_calibrated()) {
    take_newtons(data.header);
  } else {
    take_counts(data.header, options);
  }
  notes_.push_back("The export states no pillars: " + layout_note(skin_) + ".");
  take_times(data, options);
  take_mask(data);
  warn_of_header(data.header);
  warn_of_size();
  check(skin_, path.c_str());
}

/// Sets the pitch; pillars need one, the geometric mean, which keeps the area of a sensel.
void Tekscan::take_spacing(const TekscanHeader& header, const ReadOptions& options) {
  if (options.sensel_pitch_mm) {
    skin_.sensel_pitch_mm = *options.sensel_pitch_mm;
    return;
  }
  if (!header.row_spacing_mm && !header.col_spacing_mm) {
    warnings_.push_back(
        fmt::format("The export has no spacing; a sensel pitch of {} mm is assumed.",
                    skin_.sensel_pitch_mm.col_mm));
    return;
  }
  const double row_mm = header.row_spacing_mm.value_or(header.col_spacing_mm.value_or(0));
  const double col_mm = header.col_spacing_mm.value_or(row_mm);
  skin_.sensel_pitch_mm = {row_mm, col_mm};
  if (!skin_.has_pillars() || row_mm == col_mm) return;
  skin_.sensel_pitch_mm = std::sqrt(row_mm * col_mm);
  warnings_.push_back(fmt::format(
      "Rows are {:.6g} mm apart and columns {:.6g} mm; a pitch of {:.6g} mm is used for both.",
      row_mm, col_mm, skin_.sensel_pitch_mm.col_mm));
}

/// Sets the constants of an export of raw counts.
void Tekscan::take_counts(const TekscanHeader& header, const ReadOptions& options) {
  skin_.threshold_counts = options.threshold_counts.value_or(
      header.noise_threshold_counts.value_or(skin_.threshold_counts));
  if (options.full_scale_counts) {
    skin_.full_scale_counts = options.full_scale_counts;
  } else if (type_ == SenselType::u8) {
    skin_.full_scale_counts = 255;
  } else {
    warnings_.push_back(
        "Readings exceed 8 bits, so the full scale is unknown and saturation is not detected.");
  }
  if (options.counts_per_newton) {
    skin_.counts_per_newton = *options.counts_per_newton;
    return;
  }
  warnings_.push_back(fmt::format(
      "The export has no counts per newton; {} is assumed, so forces are known only up to "
      "a common factor.",
      skin_.counts_per_newton));
}

/// Readings are newtons on a sensel, of which four add up to the normal force on a pillar.
void Tekscan::take_newtons(const TekscanHeader& header) {
  skin_.counts_per_newton = skin_.has_pillars() ? 0.25 : 1;
  notes_.push_back(
      header.mpa_per_unit
          ? fmt::format("Readings are pressures; times {:.6g} mm² they are newtons on a sensel.",
                        header.area_mm2().value_or(0))
          : "Readings are newtons on a sensel.");
}

void Tekscan::take_times(TekscanExport& data, const ReadOptions& options) {
  times_s_ = std::move(data.times_s);
  const bool is_timed = !times_s_.empty();
  if (is_timed) settle_times(times_s_, options);
  if (!times_s_.empty()) return;
  if (is_timed) data.header.seconds_per_frame = 1 / *options.rate_hz;  // in place of its times
  if (!is_timed && data.header.seconds_per_frame && options.rate_hz && !options.untimed) {
    throw Error(path_.string(), "has times of its frames", "leave out --rate");
  }
  assumes_times_ = !data.header.seconds_per_frame;
  if (assumes_times_ && !options.rate_hz) {
    warnings_.push_back("The export has no times; frames are assumed to be 1 s apart.");
  }
  const double period_s = data.header.seconds_per_frame.value_or(1 / options.rate_hz.value_or(1));
  for (const std::uint64_t number : data.numbers) {
    times_s_.push_back(period_s * (static_cast<double>(number) - 1));
  }
}

void Tekscan::take_mask(TekscanExport& data) {
  calibration_.mask = std::move(data.mask);
  const std::size_t absent = count_absent(calibration_);
  if (absent == 0) {
    calibration_.mask.clear();
    return;
  }
  notes_.push_back(fmt::format("{} of {} cells have no sensel.", absent, calibration_.mask.size()));
  if (type_ == SenselType::f32 && skin_.has_pillars()) spread_outline();
}

/// Spreads the force on the present sensels of each pillar on the sensor's outline over all four:
/// its normal force is then that of its sensels, and its shear zero.
void Tekscan::spread_outline() {
  std::size_t spread_pillars = 0;
  for_each_pillar(skin_, [&](auto, auto, const auto& sensels) {
    const auto absent = std::ranges::count_if(
        sensels, [&](std::size_t i) { return calibration_.mask[i] == kAbsent; });
    if (absent == 0 || absent == 4) return;
    spread(sensels);
    ++spread_pillars;
  });
  if (spread_pillars == 0) return;
  warnings_.push_back(fmt::format(
      "{} pillars stand partly outside the sensels; their shear is unknown and set to zero.",
      spread_pillars));
}

void Tekscan::spread(const std::array<std::size_t, 4>& sensels) {
  const std::span<float> newtons = readings_.newtons();
  for (std::size_t frame = 0; frame < newtons.size(); frame += skin_.sensels()) {
    float sum = 0;
    for (const std::size_t i : sensels) {
      sum += calibration_.mask[i] == kGood ? newtons[frame + i] : 0;
    }
    for (const std::size_t i : sensels) newtons[frame + i] = sum / 4;
  }
  for (const std::size_t i : sensels) calibration_.mask[i] = kGood;
}

void Tekscan::warn_of_header(const TekscanHeader& header) {
  if (!header.units_given) warnings_.push_back("The export has no UNITS; raw counts are assumed.");
  if (!header.start_frame || !header.end_frame || *header.end_frame < *header.start_frame) return;
  const std::uint64_t announced = *header.end_frame - *header.start_frame + 1;
  if (announced == frames_) return;
  warnings_.push_back(
      fmt::format("The header announces {} frames, but the file holds {}.", announced, frames_));
}

double Tekscan::time(std::uint64_t index) {
  require_frame(index);
  return times_s_[index];
}

double Tekscan::read(std::uint64_t index, FrameBuffer& frame) {
  require_frame(index);
  require_fitting(frame);
  readings_.copy(index * skin_.sensels(), skin_.sensels(), frame.bytes().data());
  return times_s_[index];
}

bool has_line_beginning(std::string_view text, std::string_view beginning) {
  for (std::size_t at = text.find(beginning); at != std::string_view::npos;
       at = text.find(beginning, at + 1)) {
    if (at == 0 || text[at - 1] == '\n') return true;
  }
  return false;
}

bool looks_like_tekscan(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  if (head.find('\0') != std::string_view::npos) return false;
  return has_line_beginning(head, "DATA_TYPE") || has_line_beginning(head, "ASCII_DATA") ||
         (has_line_beginning(head, "Frame ") &&
          (has_line_beginning(head, "ROWS ") || has_line_beginning(head, "COLS ")));
}

}  // namespace

SourceFormat tekscan_format() {
  return {.name = "Tekscan ASCII export",
          .recognises = looks_like_tekscan,
          .open = [](const std::filesystem::path& path, const ReadOptions& options)
              -> std::unique_ptr<FileSource> { return std::make_unique<Tekscan>(path, options); }};
}

}  // namespace pillarfield
