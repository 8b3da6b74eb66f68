#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "viewer/style/colour_map.h"
#include "viewer/style/quantity.h"

namespace pillarfield::python {
namespace {

using viewer::Colour;
using viewer::Quantity;

std::optional<Quantity> quantity_named(const std::string& name) {
  for (int i = 0; i < viewer::kQuantities; ++i) {
    if (name == viewer::info_of(static_cast<Quantity>(i)).name) return static_cast<Quantity>(i);
  }
  return std::nullopt;
}

Quantity quantity_of(const std::string& name, const py::dict& planes, SkinLayout layout,
                     bool has_skin) {
  const std::optional<Quantity> quantity = quantity_named(name);
  viewer::SourceInfo source;
  source.skin.layout = layout;
  source.has_angles = planes.contains("theta");
  source.has_uncertainty = planes.contains("uncertainty_normal");
  const bool pillars = layout == SkinLayout::pillars;
  if (!quantity || *quantity == Quantity::parity) {
    throw Error("picture", "'" + name + "' is not a quantity",
                pillars ? "give normal, pressure, shear, shear_x, shear_y, magnitude, theta, phi, "
                          "region, status or uncertainty"
                        : "give normal, pressure, status or uncertainty");
  }
  if (!viewer::is_available(*quantity, source)) {
    const bool uncertain = *quantity == Quantity::uncertainty;
    throw Error("picture", "the forces have no " + name,
                uncertain ? "solve with outputs=['uncertainty']"
                : pillars ? "solve with outputs=['angles']"
                          : "give normal, pressure, status or uncertainty, which sensels have");
  }
  if (*quantity == Quantity::pressure && !has_skin) {
    throw Error("picture", "the skin is unknown, whose pitch pressure needs",
                "solve with skin=Skin(...)");
  }
  return *quantity;
}

void add(std::vector<std::uint8_t>& pixels, const Colour& colour) {
  pixels.insert(pixels.end(), {colour.red, colour.green, colour.blue});
}

Colour colour_at(Quantity quantity, const viewer::ShownField& field, const Skin& skin,
                 const viewer::Range& range, viewer::Theme theme, std::uint32_t row,
                 std::uint32_t col) {
  const std::uint8_t status = field.forces.status[std::size_t{row} * field.forces.cols + col];
  if (const auto special = viewer::special_of(quantity, status)) {
    return viewer::colour_of(*special, theme);
  }
  const viewer::Scale scale = viewer::info_of(quantity).scale;
  const float value = viewer::value_of(quantity, field, skin, row, col);
  return viewer::table_of(viewer::default_map(scale))[viewer::entry_of(value, range, scale)];
}

/// Colours of the pillars or sensels of one frame as the viewer shows them: (uint8 [rows, cols, 3],
/// low, high, unit); low and high are the ends of the colour bar, those given or fitting ones.
py::tuple paint(const py::dict& planes, const std::string& name,
                const std::optional<std::pair<float, float>>& range, bool light,
                const std::optional<Skin>& given) {
  const ForceArrays forces(planes);
  if (forces.frames() != 1) throw Error("picture", "the forces are of several frames", "give one");
  const Quantity quantity = quantity_of(name, planes, forces.layout(), given.has_value());
  Skin skin = given.value_or(Skin{});
  skin.layout = forces.layout();
  viewer::ShownField field;
  field.forces = forces.frame(0);
  viewer::Range ends = viewer::fitting_range(quantity, viewer::largest(quantity, field, skin));
  if (range) ends = {range->first, range->second};
  if (!(ends.low < ends.high)) throw Error("picture", "its range is empty", "give low < high");
  const auto theme = light ? viewer::Theme::light : viewer::Theme::dark;
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t row = 0; row < forces.rows(); ++row) {
    for (std::uint32_t col = 0; col < forces.cols(); ++col) {
      add(pixels, colour_at(quantity, field, skin, ends, theme, row, col));
    }
  }
  const viewer::Unit unit = viewer::Units{}.of(viewer::info_of(quantity).dimension);
  return py::make_tuple(array_of(std::move(pixels), {forces.rows(), forces.cols(), 3}),
                        unit.factor * double{ends.low}, unit.factor * double{ends.high}, unit.name);
}

/// The colour bar of a quantity, low to high, then the background: uint8 [257, 3].
py::array_t<std::uint8_t> colours(const std::string& name, bool light) {
  const auto quantity = quantity_named(name).value_or(Quantity::normal);
  std::vector<std::uint8_t> pixels;
  for (const Colour& colour :
       viewer::table_of(viewer::default_map(viewer::info_of(quantity).scale))) {
    add(pixels, colour);
  }
  add(pixels, viewer::background_of(light ? viewer::Theme::light : viewer::Theme::dark));
  return array_of(std::move(pixels), {static_cast<py::ssize_t>(viewer::kColours) + 1, 3});
}

}  // namespace

void bind_picture(py::module_& module) {
  module.def("paint", &paint, py::arg("planes"), py::arg("quantity"), py::arg("range"),
             py::arg("light"), py::arg("skin"),
             "Colours of the pillars or sensels of a frame, [rows, cols, 3], and low, high, unit "
             "of the bar.");
  module.def("colours", &colours, py::arg("quantity"), py::arg("light"),
             "The colour bar from low to high and the background, [257, 3].");
}

}  // namespace pillarfield::python
