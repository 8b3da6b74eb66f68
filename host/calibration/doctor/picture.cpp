#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "pillarfield/doctor.h"

namespace pillarfield {
namespace {

using MarkColour = std::array<std::uint8_t, 3>;

constexpr MarkColour kPaper = {24, 24, 24};
constexpr MarkColour kInk = {225, 225, 225};
constexpr std::uint32_t kLargestSide = 1200;  // pixels, as far as a sensel has one at least
constexpr std::uint32_t kLargestSquare = 48;
constexpr std::uint32_t kDot = 2;  ///< of a letter, pixels
constexpr std::uint32_t kLetterStep = 6 * kDot;
constexpr std::uint32_t kTextLine = 10 * kDot;
constexpr std::uint32_t kMark = 10;  ///< thickness of the mark of a line, pixels
constexpr std::uint32_t kTop = 4 * kTextLine;

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
  switch (fault) {
    case ArrayFault::absent:
      return {90, 90, 100};
    case ArrayFault::stuck:
    case ArrayFault::noisy:
      return {255, 150, 0};
    case ArrayFault::saturated:
      return {255, 0, 255};
    case ArrayFault::dead:
    case ArrayFault::dead_row:
    case ArrayFault::dead_column:
      return {255, 40, 40};
    case ArrayFault::shorted_rows:
    case ArrayFault::shorted_columns:
      return {255, 255, 0};
    default:
      return {0, 255, 255};
  }
}

/// Rectangles and letters; what lies outside of the picture is left out.
struct Sheet {
  RgbPicture picture;

  void paint(std::uint32_t top, std::uint32_t left, std::uint32_t height, std::uint32_t width,
             const MarkColour& colour) {
    for (std::uint32_t y = top; y < std::min(top + height, picture.height); ++y) {
      for (std::uint32_t x = left; x < std::min(left + width, picture.width); ++x) {
        std::ranges::copy(colour, &picture.rgb[3 * (std::size_t{y} * picture.width + x)]);
      }
    }
  }

  void write(std::uint32_t top, std::uint32_t left, std::string_view text) {
    for (const char each : text) {
      const auto place = static_cast<std::size_t>(each - ' ');
      const std::uint64_t dots = kLetters[place < kLetters.size() ? place : '?' - ' '];
      for (std::uint32_t dot = 0; dot < 35; ++dot) {
        if ((dots >> (8 * (4 - dot / 7) + dot % 7) & 1U) == 0) continue;
        paint(top + kDot * (dot % 7), left + kDot * (dot / 7), kDot, kDot, kInk);
      }
      left += kLetterStep;
    }
  }

  /// A frame in the colour of a fault; of an absent sensel a cross on paper.
  void mark(std::uint32_t top, std::uint32_t left, std::uint32_t side, ArrayFault fault) {
    const MarkColour colour = colour_of(fault);
    const std::uint32_t width = std::max(side / 8, 1U);
    if (fault == ArrayFault::absent) paint(top, left, side, side, kPaper);
    for (std::uint32_t i = 0; i < side; ++i) {
      if (fault == ArrayFault::absent) {
        paint(top + i, left + i, 1, 1, colour);
        paint(top + i, left + side - 1 - i, 1, 1, colour);
      } else {
        const bool is_whole = i < width || i + width >= side;
        paint(top + i, left, 1, is_whole ? side : width, colour);
        paint(top + i, left + side - width, 1, width, colour);
      }
    }
  }
};

std::uint32_t width_of(std::uint32_t number) {
  return kLetterStep * static_cast<std::uint32_t>(std::to_string(number).size());
}

/// The places of the sensels, in pixels.
struct SenselPlaces {
  std::uint32_t side;
  std::uint32_t left;
  std::uint32_t right;
  std::uint32_t bottom;
};

/// Marks sensels, and lines at both ends.
void mark_finding(Sheet& sheet, const ArrayFinding& finding, const SenselPlaces& places) {
  const auto& [side, left, right, bottom] = places;
  for (const auto& [row, col] : finding.sensels) {
    sheet.mark(kTop + row * side, left + col * side, side, finding.fault);
  }
  const bool is_row = is_of_rows(finding.fault);
  for (const std::uint32_t line : finding.lines) {
    const std::uint32_t at = (is_row ? kTop : left) + line * side;
    for (const std::uint32_t end : {(is_row ? left : kTop) - kMark, is_row ? right : bottom}) {
      if (is_row) sheet.paint(at, end, side, kMark, colour_of(finding.fault));
      if (!is_row) sheet.paint(end, at, kMark, side, colour_of(finding.fault));
    }
  }
}

}  // namespace

RgbPicture draw(const Diagnosis& diagnosis, const std::string& title) {
  const auto& [rows, cols] = std::pair(diagnosis.rows, diagnosis.cols);
  const std::uint32_t side = std::clamp(kLargestSide / std::max(rows, cols), 1U, kLargestSquare);
  const std::uint32_t left = 2 * kMark + width_of(rows);
  const std::uint32_t right = left + cols * side;
  const std::uint32_t bottom = kTop + rows * side;
  Sheet sheet{{std::max(right, 20 * kLetterStep) + 22 * kLetterStep,
               std::max(bottom, kTop + 12 * kTextLine) + 2 * kMark}};
  sheet.picture.rgb.resize(std::size_t{3} * sheet.picture.width * sheet.picture.height);
  sheet.paint(0, 0, sheet.picture.height, sheet.picture.width, kPaper);
  sheet.write(kMark, kMark, title);
  sheet.write(kMark + kTextLine, kMark,
              fmt::format("Largest change under load, {} x {} sensels", rows, cols));
  std::vector<float> sorted = diagnosis.picture;
  const double full = std::max(1e-30F, quantile(sorted, 0.99));
  for (std::uint32_t i = 0; i < rows * cols; ++i) {
    const auto grey = static_cast<std::uint8_t>(
        std::lround(255 * std::clamp(double{diagnosis.picture[i]} / full, 0.0, 1.0)));
    sheet.paint(kTop + i / cols * side, left + i % cols * side, side, side, {grey, grey, grey});
  }
  for (std::uint32_t row = 0; row < rows; row += kTextLine / side + 1) {
    sheet.write(kTop + row * side + side / 2 - 7, left - kMark - kDot - width_of(row),
                std::to_string(row));
  }
  for (std::uint32_t col = 0; col < cols; col += (width_of(cols) + kLetterStep) / side + 1) {
    sheet.write(kTop - kMark - kTextLine, left + col * side + side / 2 - width_of(col) / 2,
                std::to_string(col));
  }
  for (std::uint32_t y = 0; y < 100; ++y) {
    const auto grey = static_cast<std::uint8_t>(255 - 255 * y / 99);
    sheet.paint(kTop + y, right + 2 * kMark, 1, kTextLine, {grey, grey, grey});
  }
  const std::uint32_t words = right + 2 * kMark + kTextLine + kDot;
  sheet.write(kTop, words, fmt::format("{:.3g} counts", full));
  sheet.write(kTop + 100 - 7 * kDot, words, "0 counts");
  std::set<ArrayFault> named;
  for (const ArrayFinding& finding : diagnosis.findings) {
    const ArrayFault fault = finding.fault;
    mark_finding(sheet, finding, {side, left, right, bottom});
    if (finding.sensels.empty() && finding.lines.empty()) continue;
    if (!named.insert(fault).second) continue;
    const std::uint32_t at = kTop + 100 + static_cast<std::uint32_t>(named.size()) * kTextLine;
    sheet.mark(at, right + 2 * kMark, 7 * kDot, fault);
    sheet.write(at, words, fault == ArrayFault::absent ? "no sensel" : name_of(fault));
  }
  return std::move(sheet.picture);
}

}  // namespace pillarfield
