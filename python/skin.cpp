#include "pillarfield/skin.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/pitch.h"

namespace pillarfield::python {
namespace {

constexpr const char* kSurface = R"(The surface that a skin covers: a plane unless made otherwise.

The body's frame has its origin at the middle of the skin; x points right, y up, z outwards.)";

constexpr const char* kSkin =
    R"(A patch of skin: its size and the constants that all its sensels share.

Sensels are counted in rows from the top (+y) and in columns from the left (-x). The pillar at (r, c)
stands on the sensels (2r..2r+1, 2c..2c+1).

rows, cols: sensels, 1..65534, with pillars from 2 on
layout: 'pillars', one on each 2 x 2 sensels, with three components of force; 'sensels', nothing on them:
    normal force on each; without a word pillars, of which frames that do not state them warn
sensel_pitch_mm: distance of sensels, mm, by default 0.632; (7.62, 5.08) where rows lie 7.62 mm apart and
    columns 5.08 mm, without pillars
counts_per_newton: counts that a sensel reads per newton on its pillar, or on itself, 1e-2..1e6; by default 320
threshold_counts: a sensel is usable if its reading is above
full_scale_counts: a reading is saturated from here on; None: never
power_law: (exponent, reference_counts) of sensels whose response is a power of the force, or None
surface: Surface under the skin; None: unknown

Raises Error for a value out of range.)";

/// Names of the arguments of Skin(), and of the members that hold them.
const std::vector<std::string> kArguments = {"rows",
                                             "cols",
                                             "sensel_pitch_mm",
                                             "counts_per_newton",
                                             "threshold_counts",
                                             "full_scale_counts",
                                             "power_law",
                                             "surface",
                                             "layout"};

using Law = std::pair<double, double>;

std::optional<PowerLaw> law_of(const std::optional<Law>& law) {
  if (!law) return std::nullopt;
  return PowerLaw{law->first, law->second};
}

Surface height_map(const FloatPlane& heights_mm) {
  if (heights_mm.ndim() != 2) {
    throw Error("Surface.height_map", "the heights are not a two-dimensional array",
                "give [pillar rows, cols], mm");
  }
  Surface surface;
  surface.shape = SurfaceShape::height_map;
  surface.heights_mm.assign(heights_mm.data(), heights_mm.data() + heights_mm.size());
  check(surface,
        {static_cast<std::uint32_t>(heights_mm.shape(0)),
         static_cast<std::uint32_t>(heights_mm.shape(1)), Skin().pillar_pitch_mm()},
        "Surface.height_map");
  return surface;
}

Skin make_skin(std::uint32_t rows, std::uint32_t cols, const std::optional<Pitch>& sensel_pitch_mm,
               std::optional<double> counts_per_newton, double threshold_counts,
               std::optional<double> full_scale_counts, const std::optional<Law>& power_law,
               std::optional<Surface> surface, const std::optional<std::string>& layout,
               const py::kwargs& unknown) {
  refuse("Skin", unknown, kArguments);
  Skin skin;
  skin.rows = rows;
  skin.cols = cols;
  skin.sensel_pitch_mm = sensel_pitch_mm.value_or(skin.sensel_pitch_mm);
  skin.counts_per_newton = counts_per_newton.value_or(skin.counts_per_newton);
  skin.stated = {layout.has_value(), sensel_pitch_mm.has_value(), counts_per_newton.has_value()};
  skin.threshold_counts = threshold_counts;
  skin.full_scale_counts = full_scale_counts;
  skin.power_law = law_of(power_law);
  skin.surface = std::move(surface);
  skin.layout = layout_in(layout.value_or("")).value_or(skin.layout);
  check(skin, "Skin");
  return skin;
}

std::string skin_text(const Skin& skin) {
  return fmt::format("Skin({}, {}, counts_per_newton={:.6g}, threshold_counts={:.6g}{})", skin.rows,
                     skin.cols, skin.counts_per_newton, skin.threshold_counts,
                     skin.has_pillars() ? "" : ", layout='sensels'");
}

std::string surface_text(const Surface& surface) {
  std::string text = fmt::format("<Surface: {}", name_of(surface.shape));
  if (surface.shape == SurfaceShape::cylinder || surface.shape == SurfaceShape::sphere) {
    text += fmt::format(", radius {:.6g} mm", surface.radius_mm);
  }
  return text + ">";
}

/// Position, tangent_x, tangent_y and normal of each pillar: [4, rows, cols, 3], mm and unit
/// vectors.
py::array_t<double> poses(const Skin& skin) {
  std::vector<double> values;
  const std::vector<Pose> all = poses_of(skin.surface.value_or(Surface{}), skin.element_grid());
  for (const auto part : {&Pose::position_mm, &Pose::tangent_x, &Pose::tangent_y, &Pose::normal}) {
    for (const Pose& pose : all) {
      const Vector3& vector = pose.*part;
      values.insert(values.end(), {vector.x, vector.y, vector.z});
    }
  }
  return array_of(std::move(values), {4, skin.element_rows(), skin.element_cols(), 3});
}

/// The region of each status byte.
py::bytes regions() {
  std::string all;
  for (int status = 0; status < 256; ++status) {
    all += static_cast<char>(region_of(static_cast<std::uint8_t>(status)));
  }
  return all;
}

void bind_surface(py::module_& module) {
  py::class_<Surface>(module, "Surface", kSurface)
      .def(py::init([] { return Surface{}; }))
      .def_static(
          "cylinder",
          [](double radius_mm, double axis_deg) {
            return Surface{SurfaceShape::cylinder, radius_mm, axis_deg, {}};
          },
          py::arg("radius_mm"), py::kw_only(), py::arg("axis_deg") = 90.0,
          "A cylinder. radius_mm: |radius| 1..1e6, positive with the skin outside; axis_deg: "
          "direction of its axis on the skin, from +x towards +y.")
      .def_static(
          "sphere",
          [](double radius_mm) {
            return Surface{SurfaceShape::sphere, radius_mm, 90, {}};
          },
          py::arg("radius_mm"),
          "A sphere. radius_mm: |radius| 1..1e6, positive with the skin outside.")
      .def_static(
          "height_map", &height_map, py::arg("heights_mm"),
          "A surface of given heights of pillars, [pillar rows, cols], within 1e4 mm of the plane.")
      .def_property_readonly(
          "shape", [](const Surface& self) { return name_of(self.shape); },
          "'plane', 'cylinder', 'sphere' or 'height_map'")
      .def_readonly("radius_mm", &Surface::radius_mm, "radius of cylinder or sphere, mm")
      .def_readonly("axis_deg", &Surface::axis_deg, "direction of the cylinder's axis, degrees")
      .def("__repr__", &surface_text)
      .def(py::pickle(
          [](const Surface& self) {
            return py::make_tuple(static_cast<int>(self.shape), self.radius_mm, self.axis_deg,
                                  self.heights_mm);
          },
          [](const py::tuple& state) {
            return Surface{static_cast<SurfaceShape>(state[0].cast<int>()), state[1].cast<double>(),
                           state[2].cast<double>(), state[3].cast<decltype(Surface::heights_mm)>()};
          }));
}

}  // namespace

std::optional<SkinLayout> layout_in(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (const auto layout = layout_named(name)) return layout;
  throw Error("layout", fmt::format("'{}' is not a layout", name), "give 'pillars' or 'sensels'");
}

void bind_skin(py::module_& module) {
  bind_surface(module);
  py::class_<Skin>(module, "Skin", kSkin)
      .def(py::init(&make_skin), py::arg("rows"), py::arg("cols"), py::kw_only(),
           py::arg("sensel_pitch_mm") = py::none(), py::arg("counts_per_newton") = py::none(),
           py::arg("threshold_counts") = Skin{}.threshold_counts,
           py::arg("full_scale_counts") = py::none(), py::arg("power_law") = py::none(),
           py::arg("surface") = py::none(), py::arg("layout") = py::none())
      .def_readonly("rows", &Skin::rows, "sensel rows")
      .def_readonly("cols", &Skin::cols, "sensel columns")
      .def_readonly("sensel_pitch_mm", &Skin::sensel_pitch_mm, "distance of sensels, mm")
      .def_readonly("counts_per_newton", &Skin::counts_per_newton, "counts per newton on a pillar")
      .def_readonly("threshold_counts", &Skin::threshold_counts, "usable above, counts")
      .def_readonly("full_scale_counts", &Skin::full_scale_counts, "saturated from here on, counts")
      .def_readonly("surface", &Skin::surface, "Surface under the skin, or None")
      .def_property_readonly(
          "power_law",
          [](const Skin& self) {
            return self.power_law ? std::optional<Law>({self.power_law->exponent,
                                                        self.power_law->reference_counts})
                                  : std::nullopt;
          },
          "(exponent, reference in counts), or None")
      .def_property_readonly(
          "layout", [](const Skin& self) { return name_of(self.layout); },
          "'pillars', or 'sensels' without pillars")
      .def_property_readonly(
          "stated",
          [](const Skin& self) {
            std::vector<std::string> names;
            if (self.stated.layout) names.emplace_back("layout");
            if (self.states_pitch()) names.emplace_back("sensel_pitch_mm");
            if (self.states_counts_per_newton()) names.emplace_back("counts_per_newton");
            return names;
          },
          "those of 'layout', 'sensel_pitch_mm' and 'counts_per_newton' that are not assumed")
      .def(
          "mirrored",
          [](Skin self) {
            self.falling = true;
            return self;
          },
          "The skin of readings that fall under load, once they are mirrored.")
      .def_property_readonly("pillar_rows", &Skin::pillar_rows, "pillar rows")
      .def_property_readonly("pillar_cols", &Skin::pillar_cols, "pillar columns")
      .def_property_readonly("pillar_pitch_mm", &Skin::pillar_pitch_mm, "distance of pillars, mm")
      .def_property_readonly("element_rows", &Skin::element_rows, "rows of the forces")
      .def_property_readonly("element_cols", &Skin::element_cols, "columns of the forces")
      .def_property_readonly("element_pitch_mm", &Skin::element_pitch_mm,
                             "distance of pillars, or of sensels without pillars, mm")
      .def_property_readonly(
          "element_area_mm2", [](const Skin& self) { return self.element_pitch_mm().area_mm2(); },
          "area of a pillar, or of a sensel without pillars, mm²")
      .def("__repr__", &skin_text)
      .def(py::pickle(
          [](const py::object& self) {
            py::dict values;
            for (const std::string& name : kArguments)
              values[name.c_str()] = self.attr(name.c_str());
            const auto& skin = self.cast<const Skin&>();
            if (!skin.stated.layout && skin.has_pillars()) values["layout"] = py::none();
            if (!skin.states_pitch()) values["sensel_pitch_mm"] = py::none();
            if (!skin.states_counts_per_newton()) values["counts_per_newton"] = py::none();
            return values;
          },
          [](const py::dict& values) { return py::type::of<Skin>()(**values).cast<Skin>(); }));
  module.def("layout_warnings", &layout_warnings, py::arg("skin"),
             "The sentence about a skin of pillars whose layout nothing states, or none.");
  module.def("regions", &regions, "The Region of each status byte, 256 bytes.");
  module.def("poses", &poses, py::arg("skin"),
             "Position (mm), tangents and normal of each pillar: [4, pillar rows, cols, 3].");
}

}  // namespace pillarfield::python
