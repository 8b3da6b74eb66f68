#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "viewer/options.h"
#include "viewer/render/scene.h"
#include "viewer/source/curves.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint64_t kMostSampled = 16;

// Quantiles of the sampled values: the upper end of the colour bar, so that the pressure peak at
// the edge of a punch does not darken the rest; the force of an arrow of 1.5 cells.
constexpr double kRangeQuantile = 0.995;
constexpr double kArrowQuantile = 0.95;

/// Absolute values of a quantity over valid pillars of evenly spaced frames.
std::vector<float> survey(FieldProducer& producer, Quantity quantity) {
  std::vector<float> values;
  const std::uint64_t frames = producer.info().frames;
  const std::uint64_t sampled = std::min(frames, kMostSampled);
  for (std::uint64_t i = 0; i < sampled; ++i) {
    // Midpoints of equal intervals, since the first frame may be without contact.
    const ShownField field = producer.produce((2 * i + 1) * frames / (2 * sampled));
    for (std::uint32_t row = 0; row < field.forces.rows; ++row) {
      for (std::uint32_t col = 0; col < field.forces.cols; ++col) {
        const std::uint8_t status = field.forces.status[std::size_t{row} * field.forces.cols + col];
        if (special_of(quantity, status)) continue;
        const float value = std::abs(value_of(quantity, field, producer.info().skin, row, col));
        if (std::isfinite(value)) values.push_back(value);
      }
    }
  }
  return values;
}

/// The `share` quantile; 0 without values.
float quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

float typical_value(FieldProducer& producer, Quantity quantity, double share) {
  const float value = quantile(survey(producer, quantity), share);
  return without_rounding(quantity, value, quantile(survey(producer, Quantity::normal), share));
}

double full_arrow(FieldProducer& producer, Quantity quantity) {
  const float typical = typical_value(producer, quantity, kArrowQuantile);
  return typical > 0 ? round_ceiling(typical) : 1;
}

void require_available(Quantity quantity, const SourceInfo& source) {
  if (is_available(quantity, source)) return;
  const bool pillars = source.skin.has_pillars();
  throw Error(source.name, std::string("it has no data for ") + info_of(quantity).name,
              pillars ? "choose another --layer; not every file holds readings and noise"
                      : "choose another --layer; sensels without pillars feel normal force alone");
}

Surface surface_of(const Options& options, const SourceInfo& source) {
  if (options.surface) return *options.surface;
  const auto& surface = source.skin.surface;  // A height map is drawn as a plane.
  return surface && surface->shape != SurfaceShape::height_map ? *surface : Surface{};
}

}  // namespace

Range range_that_fits(FieldProducer& producer, Quantity quantity) {
  return fitting_range(quantity, typical_value(producer, quantity, kRangeQuantile));
}

std::uint64_t most_loaded_frame(FieldProducer& producer) {
  constexpr std::uint64_t kMostCompared = 64;
  const std::uint64_t frames = producer.info().frames;
  const std::uint64_t compared = std::min(frames, kMostCompared);
  std::uint64_t most_loaded = 0;
  float most_n = 0;
  for (std::uint64_t i = 0; i < compared; ++i) {
    const ShownField field = producer.produce((2 * i + 1) * frames / (2 * compared));
    const float total_n = curve_point(field, producer.info().skin.element_pitch_mm()).normal;
    if (total_n > most_n) {
      most_n = total_n;
      most_loaded = field.index;
    }
  }
  return most_loaded;
}

View first_view(const Options& options, const SourceInfo& source, const Layout& layout) {
  const SkinSize size = skin_size(source);
  if (options.orbit) {
    OrbitView view = fit_orbit(size, surface_of(options, source), layout.plot);
    view.azimuth = options.azimuth.value_or(view.azimuth);
    view.elevation = options.elevation.value_or(view.elevation);
    view.target_mm = options.centre_mm.value_or(view.target_mm);
    view.distance_mm /= options.zoom;
    return view;
  }
  TopView view = fit_top(size, layout.plot);
  view.pixels_per_mm *= options.zoom;
  view.centre_mm = options.centre_mm.value_or(view.centre_mm);
  return view;
}

RenderSettings chosen_settings(const Options& options, const SourceInfo& source, double scale) {
  require_available(options.look.quantity, source);
  RenderSettings settings = options.look;
  settings.map = options.map.value_or(default_map(info_of(settings.quantity).scale));
  settings.surface = surface_of(options, source);
  settings.scale = scale;
  if (!options.range) return settings;
  const Dimension dimension = info_of(settings.quantity).dimension;
  const auto factor = static_cast<float>(settings.units.of(dimension).factor);
  settings.range = {options.range->low / factor, options.range->high / factor};
  return settings;
}

RenderSettings default_settings(const Options& options, FieldProducer& producer, double scale) {
  RenderSettings settings = chosen_settings(options, producer.info(), scale);
  if (!options.range) settings.range = range_that_fits(producer, settings.quantity);
  settings.relief_full_n = static_cast<double>(range_that_fits(producer, Quantity::normal).high);
  if (!producer.info().skin.has_pillars()) return settings;  // No arrows.
  settings.full_force_n = full_arrow(producer, Quantity::magnitude);
  settings.full_shear_n = full_arrow(producer, Quantity::shear);
  return settings;
}

}  // namespace pillarfield::viewer
