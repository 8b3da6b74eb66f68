#include "lab/studies/contact_study_histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "pillarfield/indenter.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"

namespace pillarfield::contact_study {
namespace {

constexpr double kModulusMpa = 1;  // Young's modulus; loads are proportional to it
constexpr double kPitchMm = 1.26491106;
constexpr double kPeakCounts = 150;
constexpr double kHistoryNoiseCounts = 0.5;
constexpr double kThresholdDeviations = 4;

/// A history of one indenter: loading, radius, friction, direction.
struct Entry {
  Loading loading;
  double radius_pillars;
  double friction;
  double direction_deg;
};

std::vector<Entry> entries_of(Indenter indenter) {
  using enum Loading;
  switch (indenter) {
    case Indenter::sphere:
      return {{reverse, 3, 0.8, 56}, {swing, 16, 0.8, 266},       {fall, 5, 1.2, 99},
              {slide, 12, 1.2, 89},  {twist, 22, 1.6, 173},       {reverse, 16, 1.6, 263},
              {grow, 8, 1.6, 169},   {turn, 5, 2.2, 189},         {fall, 8, 2.2, 79},
              {turn, 3, 3.0, 51},    {touch_again, 22, 3.0, 276}, {touch_again, 5, 3.0, -4},
              {grow, 5, 4.5, 204},   {fall, 3, 4.5, 90}};
    case Indenter::fingertip:
      return {{fall, 5, 0.8, 273},   {swing, 8, 0.8, 223},       {twist, 22, 1.2, 194},
              {turn, 12, 1.2, 3},    {slide, 12, 1.6, 1},        {turn, 3, 1.6, 273},
              {grow, 3, 2.2, 279},   {slide, 5, 2.2, 98},        {reverse, 8, 2.2, 14},
              {slide, 22, 3.0, 266}, {touch_again, 8, 3.0, 274}, {touch_again, 3, 4.5, 259},
              {swing, 12, 4.5, 180}, {reverse, 12, 4.5, 52}};
    case Indenter::cylinder:
      return {{twist, 8, 0.8, 270},      {reverse, 5, 0.8, 83}, {swing, 16, 1.2, 222},
              {reverse, 8, 1.2, 83},     {fall, 3, 1.6, 273},   {slide, 8, 1.6, 276},
              {twist, 12, 1.6, 3},       {fall, 3, 2.2, 93},    {turn, 16, 2.2, 152},
              {swing, 12, 3.0, -11},     {grow, 8, 3.0, 169},   {slide, 8, 4.5, 153},
              {touch_again, 3, 4.5, 194}};
    case Indenter::punch:
      return {{reverse, 22, 0.8, 9},   {touch_again, 12, 0.8, 89}, {touch_again, 3, 1.2, 259},
              {fall, 8, 1.2, 273},     {turn, 5, 1.2, 37},         {turn, 8, 1.6, 99},
              {grow, 5, 1.6, 186},     {fall, 5, 1.6, 225},        {twist, 12, 2.2, 93},
              {grow, 16, 2.2, 284},    {turn, 16, 2.2, 215},       {fall, 5, 3.0, 3},
              {reverse, 16, 3.0, -11}, {slide, 22, 4.5, 0},        {swing, 5, 4.5, -4}};
    case Indenter::rough_ball:
      return {{slide, 8, 0.8, 169},       {turn, 8, 0.8, 139},   {reverse, 5, 0.8, 0},
              {touch_again, 5, 1.2, 259}, {swing, 12, 1.2, 274}, {slide, 16, 1.2, -4},
              {grow, 3, 1.6, 284},        {twist, 8, 1.6, 184},  {twist, 3, 1.6, 186},
              {fall, 3, 2.2, 0},          {swing, 5, 2.2, 125},  {swing, 8, 3.0, 104},
              {turn, 5, 3.0, -4},         {turn, 3, 4.5, 86},    {grow, 12, 4.5, 79}};
    case Indenter::key:
      return {{grow, 16, 0.8, 270},       {twist, 5, 0.8, 1},      {grow, 5, 0.8, -7},
              {slide, 8, 1.2, 14},        {fall, 8, 1.2, 62},      {reverse, 12, 1.2, 273},
              {touch_again, 8, 1.6, 169}, {turn, 5, 1.6, 277},     {grow, 12, 2.2, 270},
              {twist, 22, 2.2, 263},      {reverse, 16, 3.0, 202}, {grow, 5, 3.0, 79},
              {swing, 16, 4.5, 86},       {twist, 5, 4.5, 16}};
    case Indenter::two_fingers:
      break;
  }
  return {{twist, 12, 0.8, 183},      {slide, 8, 0.8, 83},    {fall, 8, 0.8, 123},
          {touch_again, 5, 1.2, 173}, {grow, 8, 1.2, 104},    {swing, 12, 1.2, 108},
          {slide, 12, 1.6, -11},      {swing, 12, 1.6, 3},    {reverse, 5, 1.6, 325},
          {touch_again, 3, 2.2, 266}, {swing, 8, 2.2, 259},   {twist, 12, 3.0, 290},
          {turn, 5, 3.0, 173},        {slide, 3, 3.0, 86},    {twist, 8, 4.5, 41},
          {touch_again, 3, 4.5, 273}, {reverse, 12, 4.5, 173}};
}

/// An indenter whose contact has about the radius `a_mm` under a load, N.
struct Indentation {
  pillarfield::Indenter indenter;
  double load_n = 0;
  double reach_mm = 0;  ///< extent of its contact from its origin
};

/// Hertz's load of a sphere of radius R for the contact radius a on an incompressible skin.
double hertz_load(double a_mm, double radius_mm) {
  return 16.0 / 9 * kModulusMpa * std::pow(a_mm, 3) / radius_mm;
}

Indentation indentation_of(const History& history, const std::filesystem::path& scenes) {
  const double a = history.radius_pillars * kPitchMm;
  // The indenter's radius grows with the contact's, which keeps strains small.
  const double radius = a * (3 + history.radius_pillars / 3);
  Indentation made;
  pillarfield::Indenter& indenter = made.indenter;
  indenter.friction = history.friction;
  indenter.radius_mm = radius;
  made.load_n = hertz_load(a, radius);
  made.reach_mm = 1.3 * a;
  switch (history.indenter) {
    case Indenter::sphere:
      break;
    case Indenter::fingertip:
    case Indenter::two_fingers:  // radii of curvature of 1.4 and 0.7 times that of the sphere
      indenter.shape = IndenterShape::ellipsoid;
      indenter.radii_mm = {std::sqrt(1.4 * 0.9) * radius, std::sqrt(0.7 * 0.9) * radius,
                           0.9 * radius};
      made.reach_mm = 1.5 * a;
      break;
    case Indenter::cylinder:
      indenter.shape = IndenterShape::cylinder;
      indenter.length_mm = 3.4 * a;
      indenter.edge_radius_mm = 0.4 * a;
      made.load_n = std::numbers::pi * kModulusMpa / 3 * 0.52 * 0.52 * a * a * 3 * a / radius;
      made.reach_mm = 2 * a;
      break;
    case Indenter::punch:
      indenter.shape = IndenterShape::punch;
      indenter.radius_mm = 1.15 * a;  // its rounded edge bears load in part
      indenter.edge_radius_mm = 0.25 * a;
      break;
    case Indenter::rough_ball:
      indenter.roughness_um = 1e3 * 0.04 * a * a / radius;
      indenter.roughness_length_mm = a;
      indenter.friction_variation = 0.1;
      indenter.friction_variation_length_mm = a;
      break;
    case Indenter::key:  // 28 mm long: contact area of a circle of 6.4 mm radius
      indenter.shape = IndenterShape::height_map;
      indenter.height_map = scenes / "key.npy";
      indenter.height_map_size_mm = {28 * a / 6.4, 12 * a / 6.4};
      indenter.height_map_depth_mm = 1.5 * a / 6.4;
      made.load_n = 20 * kModulusMpa * std::pow(a / 6.4, 2);
      made.reach_mm = 2.3 * a;
      break;
  }
  return made;
}

/// Pose of an indenter at a frame. Along and across the drag in units of the sliding distance,
/// after which the whole contact slides; turn in units of that distance over the contact radius;
/// load relative to that of the indentation.
struct Pose {
  double along = 0;
  double across = 0;
  double turn = 0;
  double load = 1;
};

std::vector<Pose> poses_of(Loading loading) {
  switch (loading) {
    case Loading::slide:
      return {{0, 0, 0, 0.5}, {0, 0, 0, 1},   {0.2, 0, 0, 1}, {0.4, 0, 0, 1}, {0.6, 0, 0, 1},
              {0.8, 0, 0, 1}, {1.0, 0, 0, 1}, {1.2, 0, 0, 1}, {1.4, 0, 0, 1}, {1.6, 0, 0, 1}};
    case Loading::twist:
      return {{0, 0, 0, 0.6}, {0, 0, 0, 1},   {0, 0, 0.3, 1}, {0, 0, 0.6, 1}, {0, 0, 0.9, 1},
              {0, 0, 1.2, 1}, {0, 0, 1.6, 1}, {0, 0, 1.4, 1}, {0, 0, 1.1, 1}, {0, 0, 0.7, 1}};
    case Loading::turn:
      return {{0, 0, 0, 1},     {0.4, 0, 0, 1},   {0.8, 0, 0, 1},   {1.1, 0, 0, 1},
              {1.3, 0, 0, 1},   {1.4, 0.3, 0, 1}, {1.4, 0.6, 0, 1}, {1.4, 0.9, 0, 1},
              {1.4, 1.2, 0, 1}, {1.4, 1.5, 0, 1}};
    case Loading::reverse:
      return {{0, 0, 0, 0.8},  {0.4, 0, 0, 1},  {0.8, 0, 0, 1}, {1.1, 0, 0, 1},
              {1.3, 0, 0, 1},  {1.0, 0, 0, 1},  {0.5, 0, 0, 1}, {0, 0, 0, 1},
              {-0.5, 0, 0, 1}, {-0.8, 0, 0, 1}, {-1.1, 0, 0, 1}};
    case Loading::swing:
      return {{0, 0, 0, 1},     {0.5, 0, 0, 1},   {1.0, 0, 0, 1},   {1.2, 0, 0, 1},
              {1.3, 0, 0, 0.7}, {1.4, 0, 0, 0.5}, {1.5, 0, 0, 0.7}, {1.6, 0, 0, 1},
              {1.8, 0, 0, 1.2}, {2.0, 0, 0, 0.9}, {2.1, 0, 0, 0.6}, {2.2, 0, 0, 0.9}};
    case Loading::grow:
      return {{0, 0, 0, 0.3},    {0.3, 0, 0, 0.3},  {0.6, 0, 0, 0.35},
              {0.8, 0, 0, 0.45}, {1.0, 0, 0, 0.55}, {1.2, 0, 0, 0.7},
              {1.4, 0, 0, 0.85}, {1.6, 0, 0, 1},    {1.8, 0, 0, 1.1}};
    case Loading::fall:
      return {{0, 0, 0, 1.1},    {0.4, 0, 0, 1.1}, {0.8, 0, 0, 1.1}, {1.1, 0, 0, 1},
              {1.2, 0, 0, 0.85}, {1.3, 0, 0, 0.7}, {1.4, 0, 0, 0.5}, {1.5, 0, 0, 0.35}};
    case Loading::touch_again:
      break;
  }
  return {{0, 0, 0, 0.5}, {0.3, 0, 0, 0.6}, {0.6, 0, 0, 0.6}, {0.9, 0, 0, 0.6}, {1.0, 0, 0, 0},
          {1.0, 0, 0, 1}, {1.4, 0, 0, 1},   {1.8, 0, 0, 1},   {2.1, 0, 0, 1},   {2.3, 0, 0, 1}};
}

/// An indenter with its path; the sliding distance is 0.84 µP / (E a) (docs/scenes.md).
pillarfield::Indenter moved(const Indentation& indentation, const History& history) {
  const double a = history.radius_pillars * kPitchMm;
  const double way_mm = 0.84 * history.friction * indentation.load_n / (kModulusMpa * a);
  const double direction = history.direction_deg * std::numbers::pi / 180;
  const double start_deg = std::fmod(61.8034 * static_cast<double>(history.seed), 180.0);
  pillarfield::Indenter indenter = indentation.indenter;
  for (const Pose& pose : poses_of(history.loading)) {
    IndenterKey key;
    key.time_s = static_cast<double>(indenter.path.size());
    key.x_mm = way_mm * (pose.along * std::cos(direction) - pose.across * std::sin(direction));
    key.y_mm = way_mm * (pose.along * std::sin(direction) + pose.across * std::cos(direction));
    key.angle_deg = start_deg + pose.turn * way_mm / a * 180 / std::numbers::pi;
    key.load_n = pose.load * indentation.load_n;
    indenter.path.push_back(key);
  }
  return indenter;
}

/// The second finger: lighter, and rotated by half a turn about a point beside the first.
pillarfield::Indenter second_finger(const pillarfield::Indenter& first, const History& history,
                                    double distance_mm) {
  const double direction = history.direction_deg * std::numbers::pi / 180;
  pillarfield::Indenter second = first;
  for (IndenterKey& key : second.path) {
    key.x_mm = -key.x_mm + distance_mm * std::sin(direction);
    key.y_mm = -key.y_mm - distance_mm * std::cos(direction);
    key.angle_deg += 70;
    key.load_n *= 0.75;
  }
  return second;
}

/// Sizes the skin to the indenters and offsets them from the pillars by the seed.
void fit_skin(Scene& scene, double reach_mm, std::uint64_t seed) {
  std::array<double, 2> low = {1e9, 1e9};
  std::array<double, 2> high = {-1e9, -1e9};
  for (const pillarfield::Indenter& indenter : scene.indenters) {
    for (const IndenterKey& key : indenter.path) {
      low = {std::min(low[0], key.x_mm), std::min(low[1], key.y_mm)};
      high = {std::max(high[0], key.x_mm), std::max(high[1], key.y_mm)};
    }
  }
  const auto sensels = [&](double length_mm) {
    return 2 * static_cast<std::uint32_t>(std::ceil((length_mm + 2 * reach_mm) / kPitchMm) + 3);
  };
  scene.skin.cols = sensels(high[0] - low[0]);
  scene.skin.rows = sensels(high[1] - low[1]);
  const auto number = static_cast<double>(seed);
  const double x = kPitchMm * (std::fmod(0.6180339887 * number, 1.0) - 0.5);
  const double y = kPitchMm * (std::fmod(0.7548776662 * number, 1.0) - 0.5);
  for (pillarfield::Indenter& indenter : scene.indenters) {
    for (IndenterKey& key : indenter.path) {
      key.x_mm += x - (low[0] + high[0]) / 2;
      key.y_mm += y - (low[1] + high[1]) / 2;
    }
  }
}

Scene scene_of(const History& history, const std::filesystem::path& scenes) {
  const Indentation indentation = indentation_of(history, scenes);
  Scene scene;
  scene.title = history.name();
  scene.modulus_kpa = 1e3 * kModulusMpa;
  scene.rate_hz = 1;
  scene.seed = history.seed;
  scene.sensor.adc_bits = 8;
  scene.sensor.noise_counts = kHistoryNoiseCounts;
  scene.skin.threshold_counts = kThresholdDeviations * kHistoryNoiseCounts;
  scene.indenters = {moved(indentation, history)};
  scene.frames = static_cast<std::uint32_t>(scene.indenters[0].path.size());
  if (history.indenter == Indenter::two_fingers) {
    const double distance_mm = 2 * indentation.reach_mm + 2 * kPitchMm;
    scene.indenters.push_back(second_finger(scene.indenters[0], history, distance_mm));
  }
  fit_skin(scene, indentation.reach_mm, history.seed);
  return scene;
}

/// True forces of each frame, from the simulator.
std::vector<ForceField> solved_truth(const Scene& scene) {
  const Simulator simulator(scene);
  FrameBuffer unused(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  std::vector<ForceField> truth;
  for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
    truth.emplace_back(scene.skin.pillar_rows(), scene.skin.pillar_cols());
    simulator.render(frame, unused, truth.back());
  }
  return truth;
}

}  // namespace

const char* name_of(Indenter indenter) {
  constexpr std::array kNames = {"sphere",     "fingertip", "cylinder",   "flat punch",
                                 "rough ball", "key",       "two fingers"};
  return kNames.at(static_cast<std::size_t>(indenter));
}

const char* name_of(Loading loading) {
  constexpr std::array kNames = {"slide", "twist",      "turn",       "reverse",
                                 "swing", "load grows", "load falls", "touch again"};
  return kNames.at(static_cast<std::size_t>(loading));
}

std::string History::name() const {
  const std::string direction =
      loading == Loading::twist ? "" : fmt::format(" at {:g}°", direction_deg);
  return fmt::format("{} {:g}, {}{}, mu {:g}", name_of(indenter), radius_pillars, name_of(loading),
                     direction, friction);
}

const std::vector<History>& histories() {
  static const std::vector<History> all_histories = [] {
    std::vector<History> all;
    for (int i = 0; i < kIndenters; ++i) {
      const auto indenter = static_cast<Indenter>(i);
      for (const Entry& entry : entries_of(indenter)) {
        all.push_back({indenter, entry.loading, entry.radius_pillars, entry.friction,
                       entry.direction_deg, 2000 + all.size()});
      }
    }
    return all;
  }();
  return all_histories;
}

Recording record(const History& history, const std::filesystem::path& scenes) {
  Scene scene = scene_of(history, scenes);
  std::vector<ForceField> truth = solved_truth(scene);
  scene.skin.counts_per_newton = kPeakCounts / largest_reading(truth);
  Recording recording = read_forces(scene, std::move(truth));
  recording.friction = history.friction;
  return recording;
}

}  // namespace pillarfield::contact_study
