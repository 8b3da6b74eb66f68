#include "calibration/weight_selection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/quantile.h"

namespace pillarfield {
namespace {

/// Sums of frames, relative to the median of their recording, between which the weight may stand.
constexpr double kLeastSum = 0.5;
constexpr double kMostSum = 2;
/// Largest share of the readings on sensels beside the edge.
constexpr double kMostAtEdge = 0.01;
/// Frames in which a sensel that never reads lies between pressed ones.
constexpr std::size_t kFewestCovered = 10;
/// Factor on the threshold from which a sensel counts as pressed.
constexpr double kPressed = 4;

}  // namespace

std::vector<SenselFinding> unresponsive_sensels(const WeightContacts& all,
                                                const Calibration& planes) {
  const std::size_t count = all.skin.sensels();
  std::vector<std::size_t> covered(count, 0);
  std::vector<std::uint8_t> responds(count, 0);
  std::vector<float> field(count, 0);
  for (const WeightFinder::Contact& contact : all.contacts) {
    for (std::size_t n = contact.begin; n < contact.end; ++n) {
      field[all.sensels[n]] = all.readings[n];
    }
    for (std::size_t n = contact.begin; n < contact.end; ++n) {
      const std::uint32_t i = all.sensels[n];
      if (all.readings[n] > all.threshold) {
        responds[i] = 1;
        continue;
      }
      const Neighbours beside(all.skin, i);
      const auto pressed = std::ranges::count_if(
          beside.edges(), [&](std::size_t at) { return field[at] > kPressed * all.threshold; });
      covered[i] += pressed >= 3 ? 1 : 0;
    }
    for (std::size_t n = contact.begin; n < contact.end; ++n) field[all.sensels[n]] = 0;
  }
  std::vector<SenselFinding> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (responds[i] != 0 || covered[i] < kFewestCovered) continue;
    found.push_back({static_cast<std::uint32_t>(i / all.skin.cols),
                     static_cast<std::uint32_t>(i % all.skin.cols), SenselFault::unresponsive, true,
                     planes.tare[i]});
  }
  return found;
}

std::vector<double> copies_of(const Calibration& planes, const Skin& skin) {
  std::vector<double> copies(skin.sensels(), 1);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    if (state_of(planes, i) != kMissing) continue;
    std::vector<std::size_t> good;
    const Neighbours around(skin, i);
    for (const std::size_t n : around.edges()) {
      if (state_of(planes, n) == kGood) good.push_back(n);
    }
    for (const std::size_t n : good) copies[n] += 1 / static_cast<double>(good.size());
  }
  return copies;
}

namespace {

/// True if the weight may stand beyond this sensel: at the edge, or beside an absent sensel.
bool is_at_edge(const Calibration& planes, const Skin& skin, std::size_t sensel) {
  const Neighbours neighbours(skin, sensel);
  return neighbours.all().size() < 8 || std::ranges::any_of(neighbours.all(), [&](std::size_t i) {
           return state_of(planes, i) == kAbsent;
         });
}

/// Sums, relative to which those of a recording's frames are judged.
double typical_sum(std::vector<double> sums) {
  constexpr double kHigh = 0.95;
  constexpr double kStands = 0.3;
  const double high = quantile(sums, kHigh);
  std::erase_if(sums, [&](double sum) { return sum < kStands * high; });
  return median(sums);
}

class FrameSelector {
 public:
  FrameSelector(const WeightContacts& all, const Calibration& planes,
                std::span<const double> weights_n)
      : all_(all), planes_(planes), weights_n_(weights_n) {
    copies_ = copies_of(planes, all.skin);
    at_edge_.resize(copies_.size());
    for (std::size_t i = 0; i < copies_.size(); ++i) {
      at_edge_[i] = is_at_edge(planes, all.skin, i) ? 1 : 0;
    }
  }

  [[nodiscard]] WeightSelection select() const {
    WeightSelection selection;
    std::vector<std::vector<double>> sums(weights_n_.size());
    for (const auto& contact : all_.contacts) sums[contact.recording].push_back(sum_of(contact));
    std::vector<double> typical;
    typical.reserve(sums.size());
    for (const auto& each : sums) typical.push_back(each.empty() ? 0 : typical_sum(each));
    std::vector<std::pair<std::size_t, std::size_t>> places;  // recording and sensel
    for (const auto& contact : all_.contacts) {
      const double sum = sum_of(contact);
      const double relative = sum / typical[contact.recording];
      if (contact.saturated) continue;  // Its sum is a part of the typical one, at least.
      if (relative < kLeastSum || relative > kMostSum) {
        ++selection.apart;
      } else if (edge_share(contact, sum) > kMostAtEdge) {
        ++selection.at_edge;
      } else {
        places.emplace_back(contact.recording, centre(contact, sum));
        selection.frames.push_back(frame_of(contact, sum));
      }
    }
    std::map<std::pair<std::size_t, std::size_t>, double> frames_at;
    for (const auto& place : places) ++frames_at[place];
    for (std::size_t t = 0; t < places.size(); ++t) {
      selection.frames[t].frames_at_place = frames_at[places[t]];
    }
    std::set<std::size_t> sensels;
    for (const auto& place : places) sensels.insert(place.second);
    selection.places = sensels.size();
    return selection;
  }

 private:
  template <class Of>
  [[nodiscard]] double sum_of(const WeightFinder::Contact& contact, Of of) const {
    double sum = 0;
    for (std::size_t n = contact.begin; n < contact.end; ++n) {
      if (all_.readings[n] > all_.threshold) {
        sum += all_.readings[n] * static_cast<double>(of(all_.sensels[n]));
      }
    }
    return sum;
  }

  [[nodiscard]] double sum_of(const WeightFinder::Contact& contact) const {
    return sum_of(contact, [](std::size_t) { return 1.0; });
  }

  [[nodiscard]] double edge_share(const WeightFinder::Contact& contact, double sum) const {
    return sum_of(contact, [&](std::size_t i) { return at_edge_[i]; }) / sum;
  }

  /// The sensel under the centre of the readings.
  [[nodiscard]] std::size_t centre(const WeightFinder::Contact& contact, double sum) const {
    const std::size_t cols = all_.skin.cols;
    const double row = sum_of(contact, [&](std::size_t i) { return i / cols; }) / sum;
    const double col = sum_of(contact, [&](std::size_t i) { return i % cols; }) / sum;
    return static_cast<std::size_t>(std::lround(row)) * cols +
           static_cast<std::size_t>(std::lround(col));
  }

  [[nodiscard]] WeighedFrame frame_of(const WeightFinder::Contact& contact, double sum) const {
    WeighedFrame frame;
    frame.weight_n = weights_n_[contact.recording];
    frame.guessed = sum_of(contact, [&](std::size_t i) { return copies_[i] - 1; }) / sum;
    for (std::size_t n = contact.begin; n < contact.end; ++n) {
      const std::uint32_t i = all_.sensels[n];
      if (state_of(planes_, i) == kGood) frame.readings.push_back({i, all_.readings[n]});
    }
    return frame;
  }

  const WeightContacts& all_;
  const Calibration& planes_;
  std::span<const double> weights_n_;
  std::vector<double> copies_;
  std::vector<std::uint8_t> at_edge_;
};

}  // namespace

WeightSelection select_frames(const WeightContacts& all, const Calibration& planes,
                              std::span<const double> weights_n) {
  return FrameSelector(all, planes, weights_n).select();
}

}  // namespace pillarfield
