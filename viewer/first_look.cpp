#include <algorithm>
#include <array>
#include <string>

#include "pillarfield/error.h"
#include "viewer/draw/scene.h"
#include "viewer/options.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint64_t kMostSurveyed = 16;

/// The largest value of each quantity in frames spread evenly over a source.
std::array<float, kQuantities> survey(FieldProducer& producer) {
  std::array<float, kQuantities> most{};
  const std::uint64_t frames = producer.info().frames;
  const std::uint64_t looked_at = std::min(frames, kMostSurveyed);
  for (std::uint64_t i = 0; i < looked_at; ++i) {
    // The middles of equal parts: at the very first frame nothing may touch yet.
    const ShownField field = producer.produce((2 * i + 1) * frames / (2 * looked_at));
    for (int q = 0; q < kQuantities; ++q) {
      const auto quantity = static_cast<Quantity>(q);
      if (!is_available(quantity, producer.info())) continue;
      float& value = most.at(static_cast<std::size_t>(q));
      value = std::max(value, largest(quantity, field));
    }
  }
  return most;
}

Range in_own_unit(const Range& shown, Quantity quantity) {
  const auto factor = static_cast<float>(info_of(quantity).factor);
  return {shown.low / factor, shown.high / factor};
}

void require_available(Quantity quantity, const SourceInfo& source) {
  if (is_available(quantity, source)) return;
  throw Error(source.name, std::string("it has nothing to show as ") + info_of(quantity).name,
              "choose another --layer; readings and noise are not in every file");
}

}  // namespace

View first_view(const Options& options, const SourceInfo& source, const Viewport& plot) {
  const SkinSize size = skin_size(source);
  if (options.orbit) {
    OrbitView view = fit_orbit(size, options.surface, plot);
    view.azimuth = options.azimuth.value_or(view.azimuth);
    view.elevation = options.elevation.value_or(view.elevation);
    view.target_mm = options.centre_mm.value_or(view.target_mm);
    view.distance_mm /= options.zoom;
    return view;
  }
  TopView view = fit_top(size, plot);
  view.pixels_per_mm *= options.zoom;
  view.centre_mm = options.centre_mm.value_or(view.centre_mm);
  return view;
}

Look first_look(const Options& options, FieldProducer& producer, double scale) {
  const SourceInfo& source = producer.info();
  require_available(options.quantity, source);
  const auto most = survey(producer);
  const auto of = [&](Quantity quantity) { return most.at(static_cast<std::size_t>(quantity)); };
  Look look;
  look.quantity = options.quantity;
  look.range = options.range ? in_own_unit(*options.range, options.quantity)
                             : fitting_range(options.quantity, of(options.quantity));
  look.map = options.map.value_or(default_map(info_of(options.quantity).scale));
  look.theme = options.theme;
  look.surface = options.surface;
  look.arrows = options.arrows;
  look.fans = options.fans;
  look.hatch = options.hatch;
  look.legend = options.legend;
  look.scale = scale;
  look.full_force_n = fitting_range(Quantity::magnitude, of(Quantity::magnitude)).high;
  look.full_shear_n = fitting_range(Quantity::shear, of(Quantity::shear)).high;
  return look;
}

}  // namespace pillarfield::viewer
