#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pillarfield/frame.h"

namespace pillarfield::python {

namespace py = pybind11;
using Shape = std::vector<py::ssize_t>;

/// An array of `shape` over memory that `owner` keeps alive.
template <class T>
py::array_t<T> array_over(const T* data, const Shape& shape, const py::object& owner,
                          bool writeable) {
  py::array_t<T> array(shape, data, owner);
  if (!writeable) array.attr("setflags")(false);
  return array;
}

/// A capsule that owns `value`.
template <class T>
py::capsule capsule_of(std::unique_ptr<T> value) {
  py::capsule owner(value.get(), [](void* pointer) { delete static_cast<T*>(pointer); });
  static_cast<void>(value.release());
  return owner;
}

/// An array that owns `values`, without a copy.
template <class T>
py::array_t<T> array_of(std::vector<T> values, const Shape& shape) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const T* const data = owned->data();
  return array_over(data, shape, capsule_of(std::move(owned)), true);
}

/// None for an empty plane, else an array [rows, cols] with a copy of it.
template <class T>
py::object plane_or_none(const std::vector<T>& plane, std::uint32_t rows, std::uint32_t cols) {
  if (plane.empty()) return py::none();
  return array_of(std::vector<T>(plane), {rows, cols});
}

/// A copy of an array [rows, cols], converted to T; empty for None. Throws Error, naming `place`,
/// if it has another shape.
template <class T>
std::vector<T> plane_from(const py::object& plane, std::uint32_t rows, std::uint32_t cols,
                          std::string_view place);

/// The type of an argument in words.
template <class T>
constexpr const char* words_of() {
  if (std::is_same_v<T, bool>) return "True or False";
  if (std::is_integral_v<T>) return "a whole number";
  if (std::is_floating_point_v<T>) return "a number";
  if (std::is_same_v<T, std::string>) return "text";
  if (std::is_same_v<T, std::vector<std::string>>) return "a list of texts";
  return "numbers";
}

/// Throws TypeError: an argument is of a wrong type.
[[noreturn]] void refuse_type(const py::handle& value, const std::string& name, const char* words);

/// An argument as T. Throws TypeError, naming it, if it is of another type.
template <class T>
T argument(const py::handle& value, const std::string& name) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    refuse_type(value, name, words_of<T>());
  }
}

/// Throws TypeError if there are arguments, of a function that knows those of other names; it
/// suggests one of them.
void refuse(const std::string& function, const py::dict& unknown,
            const std::vector<std::string>& known);

/// Throws Error unless this version pickled the state of a `type`, which begins with its version.
void check_version(const py::tuple& state, const char* type);

/// The type of readings of an array. Throws Error for types other than uint8, uint16 and float32.
[[nodiscard]] SenselType sensel_type_of(const py::array& readings);
/// The NumPy type of readings.
[[nodiscard]] py::dtype dtype_of(SenselType type);

/// A view of frame `index` of readings [frames, rows, cols], or of readings [rows, cols] for index
/// 0. Throws Error unless they are dense and aligned.
[[nodiscard]] FrameView frame_of(const py::array& readings, std::size_t index = 0);

using FloatPlane = py::array_t<float, py::array::c_style | py::array::forcecast>;

}  // namespace pillarfield::python
