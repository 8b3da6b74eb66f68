#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "pillarfield/doctor.h"

namespace pillarfield {
namespace {

using MarkColour = std::array<std::uint8_t, 3>;

constexpr MarkColour kPaper = {24, 24, 24};
constexpr MarkColour kInk = {225, 225, 225};
constexpr MarkColour kFaintInk = {90, 90, 100};
constexpr MarkColour kOfOtherFaults = {0, 255, 255};
constexpr std::array<std::pair<ArrayFault, MarkColour>, 9> kFaultColours = {
    {{ArrayFault::absent, {70, 110, 255}},
     {ArrayFault::noisy, {255, 150, 0}},
     {ArrayFault::stuck, {255, 150, 0}},
     {ArrayFault::saturated, {255, 0, 255}},
     {ArrayFault::dead, {255, 40, 40}},
     {ArrayFault::dead_row, {255, 40, 40}},
     {ArrayFault::dead_column, {255, 40, 40}},
     {ArrayFault::shorted_rows, {255, 255, 0}},
     {ArrayFault::shorted_columns, {255, 255, 0}}}};

constexpr std::uint32_t kLargestSide = 1200;  // pixels, as far as a sensel has one at least
constexpr std::uint32_t kLargestSquare = 48;
constexpr std::uint32_t kLeastFramed = 5;  ///< pixels of a square with a frame
constexpr std::uint32_t kDot = 2;          ///< pixels of a dot of a letter
constexpr std::uint32_t kLetterStep = 6 * kDot;
constexpr std::uint32_t kTextLine = 10 * kDot;
constexpr std::uint32_t kLegendWidth = 20 * kLetterStep;  ///< width

/// Letters of 5 x 7 dots from ' ' to 'z': a byte for each column, the first one highest; its lowest
/// bit is the top.
constexpr std::array<std::uint64_t, 91> kLetters = {
    0x0000000000, 0x00005f0000, 0x0007000700, 0x147f147f14, 0x242a7f2a12, 0x2313086462,
    0x3649562050, 0x0008070300, 0x001c224100, 0x0041221c00, 0x2a1c7f1c2a, 0x08083e0808,
    0x0050300000, 0x0808080808, 0x0060600000, 0x2010080402, 0x3e5149453e, 0x00427f4000,
    0x4261514946, 0x2141454b31, 0x1814127f10, 0x2745454539, 0x3c4a494930, 0x0171090503,
    0x3649494936, 0x064949291e, 0x0036360000, 0x0056360000, 0x0814224100, 0x1414141414,
    0x0041221408, 0x0201510906, 0x324979413e, 0x7e1111117e, 0x7f49494936, 0x3e41414122,
    0x7f4141221c, 0x7f49494941, 0x7f09090901, 0x3e4149497a, 0x7f0808087f, 0x00417f4100,
    0x2040413f01, 0x7f08142241, 0x7f40404040, 0x7f020c027f, 0x7f0408107f, 0x3e4141413e,
    0x7f09090906, 0x3e4151215e, 0x7f09192946, 0x4649494931, 0x01017f0101, 0x3f4040403f,
    0x1f2040201f, 0x3f4038403f, 0x6314081463, 0x0708700807, 0x6151494543, 0x007f414100,
    0x0204081020, 0x0041417f00, 0x0402010204, 0x4040404040, 0x0001020400, 0x2054545478,
    0x7f48444438, 0x3844444420, 0x384444487f, 0x3854545418, 0x087e090102, 0x0c5252523e,
    0x7f08040478, 0x00447d4000, 0x2040443d00, 0x7f10284400, 0x00417f4000, 0x7c04180478,
    0x7c08040478, 0x3844444438, 0x7c14141408, 0x081414187c, 0x7c08040408, 0x4854545420,
    0x043f444020, 0x3c4040207c, 0x1c2040201c, 0x3c4030403c, 0x4428102844, 0x0c5050503c,
    0x4464544c44};

MarkColour colour_of(ArrayFault fault) {
  for (const auto& [each, colour] : kFaultColours) {
    if (each == fault) return colour;
  }
  return kOfOtherFaults;
}

bool is_of_rows(ArrayFault fault) {
  return fault == ArrayFault::dead_row || fault == ArrayFault::shorted_rows ||
         fault == ArrayFault::row_order;
}

/// A picture of squares, one a sensel, with numbers, title, scale and legend around it.
class SenselSquares {
 public:
  SenselSquares(std::uint32_t rows, std::uint32_t cols)
      : rows_(rows),
        cols_(cols),
        side_(std::clamp(kLargestSide / std::max(rows, cols), 1U, kLargestSquare)),
        left_(kMargin + kLetterStep * static_cast<std::uint32_t>(std::to_string(rows).size())) {
    picture_.width = right() + kMargin + kLegendWidth;
    picture_.height = kTop + std::max(rows * side_, 12 * kTextLine) + kMargin;
    picture_.rgb.resize(std::size_t{3} * picture_.width * picture_.height);
    paint(0, 0, picture_.height, picture_.width, kPaper);
  }

  void fill(const SenselPlace& place, const MarkColour& colour) {
    paint(top_of(place.first), left_of(place.second), side_, side_, colour);
  }

  void frame(const SenselPlace& place, const MarkColour& colour) {
    if (side_ < kLeastFramed) return fill(place, colour);
    frame(top_of(place.first), left_of(place.second), side_, colour);
  }

  /// Paper and a cross, where the array has no sensel.
  void cross_out(const SenselPlace& place) {
    cross_out(top_of(place.first), left_of(place.second), side_);
  }

  /// Marks a row or a column in the margins at both of its ends.
  void mark(bool is_row, std::uint32_t line, const MarkColour& colour) {
    for (const std::uint32_t begin :
         {is_row ? left_ - kMark : kTop - kMark, is_row ? right() : kTop + rows_ * side_}) {
      if (is_row) paint(top_of(line), begin, side_, kMark, colour);
      if (!is_row) paint(begin, left_of(line), kMark, side_, colour);
    }
  }

  /// Writes the numbers of rows and columns, as many as there is room for.
  void number_lines() {
    const std::uint32_t widest = static_cast<std::uint32_t>(std::to_string(cols_).size()) + 1;
    for (std::uint32_t row = 0; row < rows_; row += step_of(kTextLine)) {
      const std::string text = std::to_string(row);
      write(top_of(row) + side_ / 2 - std::min(side_ / 2, 7 * kDot / 2),
            left_ - kMark - kDot - kLetterStep * static_cast<std::uint32_t>(text.size()), text);
    }
    for (std::uint32_t col = 0; col < cols_; col += step_of(widest * kLetterStep)) {
      const std::string text = std::to_string(col);
      const std::uint32_t half = kLetterStep * static_cast<std::uint32_t>(text.size()) / 2;
      write(kTop - kMark - kTextLine, left_of(col) + side_ / 2 - std::min(side_ / 2, half), text);
    }
  }

  void title(std::string_view line, std::string_view below) {
    write(kDot * 4, kMark, line);
    write(kDot * 4 + kTextLine, kMark, below);
  }

  /// A bar of greys from 0 to `full`, beside the squares.
  void scale(const std::string& full) {
    const std::uint32_t height = 5 * kTextLine;
    for (std::uint32_t y = 0; y < height; ++y) {
      const auto grey = static_cast<std::uint8_t>(255 - 255 * y / (height - 1));
      paint(kTop + y, right() + kMargin, 1, kTextLine, {grey, grey, grey});
    }
    write(kTop, right() + kMargin + kTextLine + kDot * 3, full);
    write(kTop + height - 7 * kDot, right() + kMargin + kTextLine + kDot * 3, "0 counts");
    legend_ = kTop + 6 * kTextLine;
  }

  void add_to_legend(ArrayFault fault) {
    const std::uint32_t left = right() + kMargin;
    const std::uint32_t side = 7 * kDot;
    if (legend_ + kTextLine > picture_.height) return;
    if (fault == ArrayFault::absent) cross_out(legend_, left, side);
    if (fault != ArrayFault::absent) frame(legend_, left, side, colour_of(fault));
    write(legend_, left + kTextLine, fault == ArrayFault::absent ? "no sensel" : name_of(fault));
    legend_ += kTextLine;
  }

  [[nodiscard]] RgbPicture take() { return std::move(picture_); }

 private:
  static constexpr std::uint32_t kMark = 10;
  static constexpr std::uint32_t kMargin = 2 * kMark;
  static constexpr std::uint32_t kTop = 4 * kTextLine;

  [[nodiscard]] std::uint32_t top_of(std::uint32_t row) const { return kTop + row * side_; }
  [[nodiscard]] std::uint32_t left_of(std::uint32_t col) const { return left_ + col * side_; }
  [[nodiscard]] std::uint32_t right() const { return left_of(cols_); }

  /// Lines from number to number: 1, 2, 5, 10, ... of at least so many pixels.
  [[nodiscard]] std::uint32_t step_of(std::uint32_t pixels) const {
    for (std::uint32_t ten = 1;; ten *= 10) {
      for (const std::uint32_t step : {ten, 2 * ten, 5 * ten}) {
        if (step * side_ >= pixels) return step;
      }
    }
  }

  void frame(std::uint32_t top, std::uint32_t left, std::uint32_t side, const MarkColour& colour) {
    const std::uint32_t width = std::max(side / 8, 1U);
    paint(top, left, width, side, colour);
    paint(top + side - width, left, width, side, colour);
    paint(top, left, side, width, colour);
    paint(top, left + side - width, side, width, colour);
  }

  void cross_out(std::uint32_t top, std::uint32_t left, std::uint32_t side) {
    paint(top, left, side, side, kPaper);
    for (std::uint32_t i = side / 4; i < side - side / 4; ++i) {
      paint(top + i, left + i, 1, 1, kFaintInk);
      paint(top + i, left + side - 1 - i, 1, 1, kFaintInk);
    }
  }

  void write(std::uint32_t top, std::uint32_t left, std::string_view text) {
    for (const char each : text) {
      const bool is_known = each >= ' ' && each <= 'z';
      const std::uint64_t dots =
          kLetters.at(static_cast<std::size_t>((is_known ? each : '?') - ' '));
      for (std::uint32_t dot = 0; dot < 35; ++dot) {
        const std::uint32_t x = dot / 7;
        const std::uint32_t y = dot % 7;
        if ((dots >> (8 * (4 - x) + y) & 1U) == 0) continue;
        paint(top + kDot * y, left + kDot * x, kDot, kDot, kInk);
      }
      left += kLetterStep;
    }
  }

  /// Paints a rectangle, as far as it lies in the picture.
  void paint(std::uint32_t top, std::uint32_t left, std::uint32_t height, std::uint32_t width,
             const MarkColour& colour) {
    for (std::uint32_t y = top; y < std::min(top + height, picture_.height); ++y) {
      for (std::uint32_t x = left; x < std::min(left + width, picture_.width); ++x) {
        std::ranges::copy(
            colour, picture_.rgb.begin() +
                        static_cast<std::ptrdiff_t>(3 * (std::size_t{y} * picture_.width + x)));
      }
    }
  }

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::uint32_t side_;  ///< of a square, pixels
  std::uint32_t left_;  ///< of the squares, pixels
  std::uint32_t legend_ = 0;
  RgbPicture picture_;
};

}  // namespace

RgbPicture draw(const Diagnosis& diagnosis, const std::string& title) {
  SenselSquares squares(diagnosis.rows, diagnosis.cols);
  std::vector<float> sorted = diagnosis.picture;
  const double full = std::max(1e-30F, quantile(sorted, 0.99));
  for (std::uint32_t row = 0; row < diagnosis.rows; ++row) {
    for (std::uint32_t col = 0; col < diagnosis.cols; ++col) {
      const double signal = diagnosis.picture[std::size_t{row} * diagnosis.cols + col];
      const auto grey =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(signal / full, 0.0, 1.0)));
      squares.fill({row, col}, {grey, grey, grey});
    }
  }
  squares.number_lines();
  squares.title(title, fmt::format("Largest change under load, {} x {} sensels", diagnosis.rows,
                                   diagnosis.cols));
  squares.scale(fmt::format("{:.3g} counts", full));
  std::vector<ArrayFault> named;
  for (const ArrayFinding& finding : diagnosis.findings) {
    const MarkColour colour = colour_of(finding.fault);
    for (const SenselPlace& place : finding.sensels) {
      if (finding.fault == ArrayFault::absent) squares.cross_out(place);
      if (finding.fault != ArrayFault::absent) squares.frame(place, colour);
    }
    for (const std::uint32_t line : finding.lines) {
      squares.mark(is_of_rows(finding.fault), line, colour);
    }
    if ((finding.sensels.empty() && finding.lines.empty()) ||
        std::ranges::find(named, finding.fault) != named.end()) {
      continue;
    }
    named.push_back(finding.fault);
    squares.add_to_legend(finding.fault);
  }
  return squares.take();
}

}  // namespace pillarfield
