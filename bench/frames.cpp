#include "bench/frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "pillarfield/status.h"

namespace pillarfield::bench {
namespace {

using Random = std::mt19937;
using Quartet = std::array<double, 4>;  ///< readings of the sensels 1 to 4, counts

constexpr std::size_t kMostFrames = 64;
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr std::size_t kQuartets = 1024;      ///< distinct ones of a region
constexpr std::size_t kTapePillars = 16384;  ///< before a tape repeats

/// A force of 1 to 170 counts, log-uniform, direction uniform over the hemisphere: sensels read at
/// most 240, and some forces activate only one.
Quartet random_readings(Random& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double magnitude = std::pow(170, uniform(random));
  const double cosine = uniform(random);
  const double shear = magnitude * std::sqrt(1 - cosine * cosine);
  const double phi = 2 * std::numbers::pi * uniform(random);
  const double x = -shear * std::cos(phi) / std::numbers::sqrt2;
  const double y = -shear * std::sin(phi) / std::numbers::sqrt2;
  const double normal = magnitude * cosine;
  // Equation (2). Below half a count a sensel is inactive in every type.
  const auto active = [](double reading) { return reading < 0.5 ? 0.0 : reading; };
  return {active(normal + x + y), active(normal - x + y), active(normal - x - y),
          active(normal + x - y)};
}

std::uint8_t usable(const Quartet& v) {
  return static_cast<std::uint8_t>(
      (v[0] > 0 ? status::kSensel1 : 0) | (v[1] > 0 ? status::kSensel2 : 0) |
      (v[2] > 0 ? status::kSensel3 : 0) | (v[3] > 0 ? status::kSensel4 : 0));
}

/// Random readings of one region, or of all regions.
std::vector<Quartet> draw(Touch touch, Random& random) {
  std::vector<Quartet> drawn;
  while (drawn.size() < kQuartets) {
    const Quartet readings = touch == Touch::idle ? Quartet{} : random_readings(random);
    const Region region = region_of(usable(readings));
    const bool fits = touch == Touch::mixed || touch == Touch::idle
                          ? (region != Region::none) == (touch == Touch::mixed)
                          : static_cast<int>(region) == static_cast<int>(touch) + 1;
    if (fits) drawn.push_back(readings);
  }
  return drawn;
}

/// The pools from which neighbouring pillars draw readings in turns.
std::vector<std::vector<Quartet>> pools(Touch touch, Random& random) {
  if (touch != Touch::worst) return {draw(touch, random)};
  std::vector<std::vector<Quartet>> all;
  for (const Touch each : {Touch::one, Touch::two, Touch::three, Touch::four, Touch::idle}) {
    all.push_back(draw(each, random));
  }
  return all;
}

template <class Reading>
Reading stored(double counts) {
  if constexpr (sizeof(Reading) == 1) return static_cast<Reading>(std::lround(counts));
  if constexpr (sizeof(Reading) == 2) return static_cast<Reading>(std::lround(16 * counts));
  return static_cast<Reading>(counts);
}

/// Two long rows of readings; every row of pillars of every frame is a piece of them.
template <class Reading>
struct Tape {
  Tape(Touch touch, std::uint32_t cols, Random& random) {
    const auto from = pools(touch, random);
    for (std::size_t pillar = 0; pillar < kTapePillars; ++pillar) {
      const Quartet& v = from[pillar % from.size()][random() % kQuartets];
      top.insert(top.end(), {stored<Reading>(v[1]), stored<Reading>(v[0])});
      bottom.insert(bottom.end(), {stored<Reading>(v[2]), stored<Reading>(v[3])});
    }
    // A piece may start at any pillar.
    for (std::size_t i = 0; i < 2 * std::size_t{cols}; ++i) {
      top.push_back(top[i]);
      bottom.push_back(bottom[i]);
    }
  }
  std::vector<Reading> top;
  std::vector<Reading> bottom;
};

struct PillarSpan {
  std::uint32_t first;
  std::uint32_t count;
};

/// Round contacts that circle the centres of grid cells.
class Contacts {
 public:
  Contacts(const Skin& skin, double fraction, double turns)
      : rows_(skin.pillar_rows()), cols_(skin.pillar_cols()), turns_(turns) {
    constexpr double kContacts = kGridRows * kGridCols;
    const auto pillars = static_cast<double>(skin.pillars());
    radius_ = std::sqrt(fraction * pillars / (kContacts * std::numbers::pi));
  }

  /// The pillars of a row that lie in contacts.
  [[nodiscard]] std::vector<PillarSpan> spans(std::uint32_t row) const {
    std::vector<PillarSpan> cut;
    const double cell_rows = static_cast<double>(rows_) / kGridRows;
    const double cell_cols = static_cast<double>(cols_) / kGridCols;
    const double orbit = std::max(0.0, std::min(cell_rows, cell_cols) / 2 - radius_ - 1);
    const double across = orbit * std::cos(2 * std::numbers::pi * turns_);
    const double down = orbit * std::sin(2 * std::numbers::pi * turns_);
    const double cell = std::floor(row / cell_rows);
    const double distance = row - ((cell + 0.5) * cell_rows + down);
    if (std::abs(distance) >= radius_) return cut;
    const double half = std::sqrt(radius_ * radius_ - distance * distance);
    for (int col = 0; col < kGridCols; ++col) {
      const double centre = (col + 0.5) * cell_cols + across;
      const double low = std::clamp(std::round(centre - half), 0.0, double{cols_});
      const double high = std::clamp(std::round(centre + half), low, double{cols_});
      cut.push_back({static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high - low)});
    }
    return cut;
  }

 private:
  static constexpr int kGridRows = 2;
  static constexpr int kGridCols = 4;
  double rows_;
  double cols_;
  double turns_;
  double radius_ = 0;
};

template <class Reading>
void fill(std::vector<FrameBuffer>& frames, const Skin& skin, const Scenario& scenario) {
  Random random(1);
  const Tape<Reading> tape(scenario.touch, skin.pillar_cols(), random);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double turns = static_cast<double>(i) / static_cast<double>(frames.size());
    const Contacts contacts(skin, scenario.contact, turns);
    Reading* const readings = frames[i].readings<Reading>().data();
    for (std::uint32_t row = 0; row < skin.pillar_rows(); ++row) {
      const std::size_t piece = 2 * (random() % kTapePillars);
      const auto spans = scenario.contact < 1 ? contacts.spans(row)
                                              : std::vector<PillarSpan>{{0, skin.pillar_cols()}};
      for (const PillarSpan& span : spans) {
        Reading* const to = readings + std::size_t{2} * row * skin.cols + 2 * span.first;
        std::copy_n(tape.top.data() + piece, 2 * span.count, to);
        std::copy_n(tape.bottom.data() + piece, 2 * span.count, to + skin.cols);
      }
    }
  }
}

void fill(std::vector<FrameBuffer>& frames, SenselType type, const Skin& skin,
          const Scenario& scenario) {
  switch (type) {
    case SenselType::u8:
      return fill<std::uint8_t>(frames, skin, scenario);
    case SenselType::u16:
      return fill<std::uint16_t>(frames, skin, scenario);
    case SenselType::f32:
      return fill<float>(frames, skin, scenario);
  }
}

}  // namespace

Frames::Frames(const Skin& skin, SenselType type, const Scenario& scenario) {
  const std::size_t fit = kMostBytes / (skin.sensels() * size_of(type));
  const std::size_t count = std::clamp<std::size_t>(fit, 2, kMostFrames);
  for (std::size_t i = 0; i < count; ++i) frames_.emplace_back(type, skin.rows, skin.cols);
  fill(frames_, type, skin, scenario);
}

}  // namespace pillarfield::bench
