#include "pillarfield/array_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/nearest_word.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace pillarfield {
namespace {

const std::vector<std::string> kAxisWords = {"frames", "rows", "columns"};

/// Ratio of the longer to the shorter side of a frame.
double elongation(double one, double other) {
  return std::max(one, other) / std::max(1.0, std::min(one, other));
}

/// Sum and number of the absolute differences of neighbours; NaN is left out.
struct Variation {
  double sum = 0;
  double count = 0;

  void add(double before, double after) {
    const double difference = std::abs(after - before);
    if (!std::isfinite(difference)) return;
    sum += difference;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
};

template <class Reading>
void add_frame(const FrameBuffer& frame, const FrameBuffer& next,
               std::array<Variation, 3>& variations) {
  const std::span<const Reading> readings = frame.readings<Reading>();
  const std::span<const Reading> later = next.readings<Reading>();
  const std::size_t cols = frame.view().cols;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    variations[0].add(readings[i], later[i]);
    if (i + cols < readings.size()) variations[1].add(readings[i], readings[i + cols]);
    if ((i + 1) % cols != 0) variations[2].add(readings[i], readings[i + 1]);
  }
}

/// Mean difference of neighbours along frames, rows and columns, in some frames and their next.
std::array<Variation, 3> variations_of(FrameSource& source) {
  constexpr std::uint64_t kMostPairs = 8;
  const SenselType type = source.sensel_type();
  FrameBuffer frame(type, source.skin().rows, source.skin().cols);
  FrameBuffer next(type, source.skin().rows, source.skin().cols);
  std::array<Variation, 3> variations;
  const std::uint64_t pairs = std::min(kMostPairs, source.frames() - 1);
  for (std::uint64_t pair = 0; pair < pairs; ++pair) {
    const std::uint64_t index = pair * (source.frames() - 1) / pairs;
    source.read(index, frame);
    source.read(index + 1, next);
    if (type == SenselType::u8) add_frame<std::uint8_t>(frame, next, variations);
    if (type == SenselType::u16) add_frame<std::uint16_t>(frame, next, variations);
    if (type == SenselType::f32) add_frame<float>(frame, next, variations);
  }
  return variations;
}

/// An order of axes that gives more frames; `axis` counts them.
struct OtherAxes {
  std::size_t axis;
  const char* words;
  double times_squarer;
};

std::optional<OtherAxes> axes_of_more_frames(const FrameSource& source) {
  const auto frames = static_cast<double>(source.frames());
  const double rows = source.skin().rows;
  const double cols = source.skin().cols;
  const double given = elongation(rows, cols);
  const OtherAxes last = {2, "rows,columns,frames", given / elongation(frames, rows)};
  const OtherAxes middle = {1, "rows,frames,columns", given / elongation(frames, cols)};
  if (frames < 2) return std::nullopt;
  if (cols > frames && cols >= rows) return last;
  if (rows > frames) return middle;
  return std::nullopt;
}

}  // namespace

std::vector<ArrayAxis> parse_axes(std::string_view words) {
  std::vector<ArrayAxis> axes;
  for (std::string_view rest = words; !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    const std::string word(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const auto known = std::ranges::find(kAxisWords, word);
    if (known == kAxisWords.end()) {
      throw Error("axes",
                  fmt::format("'{:.30}' is not an axis{}", word, suggestion(word, kAxisWords)),
                  "give frames, rows and columns in the order of the array");
    }
    axes.push_back(static_cast<ArrayAxis>(known - kAxisWords.begin()));
  }
  std::vector<ArrayAxis> sorted = axes;
  std::ranges::sort(sorted);
  using enum ArrayAxis;
  if (sorted == std::vector{frames, rows, columns} || sorted == std::vector{rows, columns}) {
    return axes;
  }
  throw Error("axes", fmt::format("'{:.60}' does not name each axis once", words),
              "give frames, rows and columns in the order of the array");
}

void require_likely_axes(FrameSource& frames, const std::string& place) {
  // In recordings of two pads and a mattress, of 10 to 400 frames, the product of both ratios is at
  // most 0.9 in the right order and 3.2 or more with frames last.
  constexpr double kDoubtful = 2.5;
  const auto other = axes_of_more_frames(frames);
  if (!other) return;
  const auto variations = variations_of(frames);
  const double along_first = variations[0].mean();
  const double along_other = variations[other->axis].mean();
  const bool is_constant = !(along_first > 0) && !(along_other > 0);
  const double first = is_constant ? 1 : along_first;
  if (!(other->times_squarer * first > kDoubtful * (is_constant ? 1 : along_other))) return;
  throw Error(
      place,
      fmt::format("in the order frames,rows,columns it would be {} frames of {} x {}, which "
                  "is doubtful",
                  frames.frames(), frames.skin().rows, frames.skin().cols),
      fmt::format("name its axes: --axes {} (in Python axes=), or frames,rows,columns if "
                  "that is right",
                  other->words));
}

void require_likely_frame(std::uint64_t rows, std::uint64_t cols, const std::string& place) {
  constexpr double kMostElongation = 4;
  if (elongation(static_cast<double>(rows), static_cast<double>(cols)) < kMostElongation) return;
  throw Error(
      place,
      fmt::format("has {0} lines of {1} numbers; it is doubtful that it is one frame of {0} "
                  "x {1}",
                  rows, cols),
      "if each line is a frame, give --shape ROWSxCOLS (in Python reshape it); if it is one "
      "frame, --axes rows,columns (in Python axes=)");
}

std::vector<std::string> size_warnings(std::uint32_t rows, std::uint32_t cols) {
  std::vector<std::string> warnings;
  const auto warn_if_odd = [&](std::uint32_t count, const char* what) {
    if (count % 2 == 0) return;
    warnings.push_back(
        fmt::format("The last of the {} sensel {} has no pillars; it is ignored.", count, what));
  };
  warn_if_odd(rows, "rows");
  warn_if_odd(cols, "columns");
  return warnings;
}

}  // namespace pillarfield
