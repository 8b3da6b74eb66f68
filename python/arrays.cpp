#include "python/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "base/nearest_word.h"
#include "pillarfield/error.h"
#include "pillarfield/version.h"

namespace pillarfield::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    text += fmt::format("{}{}", axis == 0 ? "" : " x ", array.shape(axis));
  }
  return array.ndim() == 0 ? "a scalar" : text;
}

template <class T>
bool is_of(const py::array& array) {
  return py::isinstance<py::array_t<T, 0>>(array);
}

std::uint32_t length_of(const py::array& array, py::ssize_t axis) {
  const py::ssize_t length = array.shape(axis);
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw Error("array", fmt::format("{} values along an axis", length), "give fewer");
  }
  return static_cast<std::uint32_t>(length);
}

}  // namespace

template <class T>
std::vector<T> plane_from(const py::object& plane, std::uint32_t rows, std::uint32_t cols,
                          std::string_view place) {
  if (plane.is_none()) return {};
  using Dense = py::array_t<T, py::array::c_style | py::array::forcecast>;
  const Dense array(plane);
  if (array.ndim() != 2 || array.shape(0) != rows || array.shape(1) != cols) {
    throw Error(place, fmt::format("the array is {}", shape_text(array)),
                fmt::format("give {} x {}", rows, cols));
  }
  return {array.data(), array.data() + array.size()};
}

template std::vector<float> plane_from<float>(const py::object&, std::uint32_t, std::uint32_t,
                                              std::string_view);
template std::vector<std::uint8_t> plane_from<std::uint8_t>(const py::object&, std::uint32_t,
                                                            std::uint32_t, std::string_view);

void refuse_type(const py::handle& value, const std::string& name, const char* words) {
  constexpr std::size_t kLongest = 60;
  std::string text = py::repr(value).cast<std::string>();
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  throw py::type_error(fmt::format("{} is {}; give {}", name, text, words));
}

void refuse(const std::string& function, const py::dict& unknown,
            const std::vector<std::string>& known) {
  if (unknown.empty()) return;
  const auto name = py::str(unknown.begin()->first).cast<std::string>();
  throw py::type_error(
      fmt::format("{}() has no argument '{}'{}", function, name, suggestion(name, known)));
}

void check_version(const py::tuple& state, const char* type) {
  if (state[0].cast<std::string>() == kVersion) return;
  throw Error(type, "another version of pillarfield pickled it", "pickle it again by this one");
}

SenselType sensel_type_of(const py::array& readings) {
  if (is_of<std::uint8_t>(readings)) return SenselType::u8;
  if (is_of<std::uint16_t>(readings)) return SenselType::u16;
  if (is_of<float>(readings)) return SenselType::f32;
  throw Error("frames",
              fmt::format("their type is {}", py::str(readings.dtype()).cast<std::string>()),
              "give uint8, uint16 or float32");
}

py::dtype dtype_of(SenselType type) { return py::dtype(std::string(name_of(type))); }

FrameView frame_of(const py::array& readings, std::size_t index) {
  const SenselType type = sensel_type_of(readings);
  const py::ssize_t axes = readings.ndim();
  const auto frames = axes == 3 ? static_cast<std::size_t>(readings.shape(0)) : 1;
  if ((axes != 2 && axes != 3) || index >= frames) {
    throw Error("frames", fmt::format("the array is {}", shape_text(readings)),
                "give [rows, cols] for a frame, [frames, rows, cols] for several");
  }
  const auto* const data = static_cast<const std::byte*>(readings.data());
  if ((readings.flags() & py::array::c_style) == 0 ||
      reinterpret_cast<std::uintptr_t>(data) % size_of(type) != 0) {
    throw Error("frames", "the array is not dense and aligned",
                "give numpy.ascontiguousarray() of it");
  }
  const std::uint32_t rows = length_of(readings, axes - 2);
  const std::uint32_t cols = length_of(readings, axes - 1);
  const std::size_t bytes = std::size_t{rows} * cols * size_of(type);
  return {data + index * bytes, type, rows, cols, cols};
}

}  // namespace pillarfield::python
