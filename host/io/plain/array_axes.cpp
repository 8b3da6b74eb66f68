#include "pillarfield/array_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/nearest_word.h"
#include "base/npy.h"
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

/// Three components along an axis, by what they do.
struct AxisComponents {
  std::optional<std::size_t> normal;  ///< differs most from its rest: friction bounds the shear
  bool are_signed = false;
};

AxisComponents components_along(const std::vector<std::uint64_t>& shape, std::size_t axis,
                                const SliceReader& read) {
  constexpr std::uint64_t kMostValues = std::uint64_t{1} << 23U;
  constexpr std::uint64_t kMostLooks = 64;
  constexpr double kClearly = 1.3;
  constexpr double kSigned = 0.03;
  std::uint64_t inner = 1;  // of each component
  std::uint64_t values = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) values *= shape[i];
  for (std::size_t i = axis + 1; i < shape.size(); ++i) inner *= shape[i];
  if (values == 0 || values > kMostValues) return {};
  const std::uint64_t looks = std::clamp<std::uint64_t>(kMostValues / values, 3, kMostLooks);
  std::vector<std::vector<double>> slices;
  const std::uint64_t count = std::min(looks, shape[0]);
  for (std::uint64_t look = 0; look < count; ++look) {
    slices.push_back(read(look * shape[0] / count));
  }
  std::array<double, 3> activity = {};
  double low = 0;
  double high = 0;
  std::vector<double> times(slices.size());
  for (std::size_t i = 0; i < values; ++i) {
    for (std::size_t t = 0; t < slices.size(); ++t) times[t] = slices[t][i];
    std::ranges::nth_element(times, times.begin() + std::ssize(times) / 2);
    const bool is_alone = axis == 0 || times.size() == 1;
    const double rest = is_alone ? 0 : times[times.size() / 2];
    for (std::size_t t = 0; t < slices.size(); ++t) {
      const double change = slices[t][i] - rest;
      if (!std::isfinite(change)) continue;
      activity[axis == 0 ? t : i / inner % 3] += std::abs(change);
      low = std::min(low, slices[t][i]);
      high = std::max(high, slices[t][i]);
    }
  }
  AxisComponents found = {.normal = {},
                          .are_signed = std::min(-low, high) > kSigned * std::max(-low, high)};
  const auto most = std::ranges::max_element(activity);
  std::array<double, 3> sorted = activity;
  std::ranges::sort(sorted);
  if (sorted[2] > kClearly * sorted[1])
    found.normal = static_cast<std::size_t>(most - activity.begin());
  return found;
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

void require_frame_axes(const std::vector<std::uint64_t>& shape, const SliceReader& read,
                        const std::string& place,
                        const std::function<std::string(const std::string& index)>& take) {
  const std::size_t axes = shape.size();
  if (axes < 3 || axes > 5) return;
  const bool is_planes = axes == 3 && shape[0] == 3 && shape[1] > 3 && shape[2] > 3;
  const bool is_last = shape.back() == 3;
  const std::size_t first = is_planes ? 0 : axes - 3;
  const bool has_components = is_last || (shape[first] == 3 && (axes > 3 || is_planes));
  std::string what;
  std::string component;
  if (has_components) {
    const std::size_t axis = is_last ? axes - 1 : first;
    const AxisComponents found = components_along(shape, axis, read);
    const bool is_small = axes == 3 && shape[1] < 4;
    if ((is_planes || is_small) && !found.are_signed) return;
    what = fmt::format("axis {} is of three components", axis);
    component = found.normal ? std::to_string(*found.normal) : "K";
  } else if (axes == 3) {
    return;
  }
  const bool has_pads = axes == 5 || !has_components;
  std::string index = is_last && has_components ? "[..., " + component + "]"
                      : is_planes               ? "[" + component + "]"
                                                : "[:, " + component + "]";
  if (has_pads) {
    what += fmt::format("{}axis 1 is of {} pads", what.empty() ? "" : ", ", shape[1]);
    index = !has_components ? "[:, 0]"
            : is_last       ? "[:, 0, ..., " + component + "]"
                            : "[:, 0, " + component + "]";
  }
  throw Error(
      place,
      fmt::format("has the shape {}, and {}, which are no sensels", text_of_shape(shape), what),
      fmt::format("{}{}{}", take(index), component == "K" ? ", with K of the normal one" : "",
                  axes == 3 ? "; or name the axes, --axes 'frames,rows,columns'" : ""));
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
      fmt::format("name its axes: --axes '{}', or 'frames,rows,columns' if that is right",
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
      "if each line is a frame, give --shape ROWSxCOLS; if it is one frame, --axes "
      "'rows,columns'");
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
