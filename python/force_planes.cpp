#include "python/force_planes.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/skin.h"

namespace pillarfield::python {

void ForceStack::Plane::resize(std::size_t frames) {
  auto* const moved = static_cast<std::byte*>(
      std::realloc(memory.get(), std::max<std::size_t>(1, frames * frame_bytes)));
  if (moved == nullptr) throw std::bad_alloc();
  static_cast<void>(memory.release());
  memory.reset(moved);
}

void ForceStack::reserve(std::size_t frames) {
  capacity_ = frames;
  for (Plane& plane : planes_) {
    if (plane.memory) plane.resize(frames);
  }
  if (status_.memory) status_.resize(frames);
}

void ForceStack::append(Plane& plane, std::span<const std::byte> frame) {
  if (frame.empty()) return;
  if (!plane.memory) {
    plane.frame_bytes = frame.size();
    plane.resize(capacity_);
  }
  std::memcpy(plane.memory.get() + frames_ * plane.frame_bytes, frame.data(), frame.size());
}

void ForceStack::append(const ForceFieldView& forces) {
  if (frames_ == capacity_) reserve(std::max<std::size_t>(16, 2 * capacity_));
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    append(planes_[i], std::as_bytes(plane_of(forces, i)));
  }
  append(status_, std::as_bytes(forces.status));
  ++frames_;
}

py::dict ForceStack::release() {
  const Shape shape = {static_cast<py::ssize_t>(frames_), rows_, cols_};
  const auto array = [&]<class T>(Plane& plane, T) -> py::object {
    if (!plane.memory) return py::array_t<T>(shape);  // No frame.
    if (frames_ < capacity_) plane.resize(frames_);
    auto* const data = plane.memory.release();
    const py::capsule owner(data, &std::free);
    return array_over(reinterpret_cast<const T*>(data), shape, owner, true);
  };
  py::dict planes;
  for (const ResultPlane& plane : kResultPlanes) {
    if (plane.index >= kSolvedPlanes) break;
    if (plane.set != PlaneSet::forces && !planes_[plane.index].memory) continue;
    if (!has_plane(layout_, true, true, plane)) continue;
    planes[plane.field().c_str()] = array(planes_[plane.index], float{});
  }
  planes["status"] = array(status_, std::uint8_t{});
  frames_ = capacity_ = 0;
  return planes;
}

py::dict lent_planes(const ForceFieldView& forces, const py::object& owner) {
  const Shape shape = {forces.rows, forces.cols};
  py::dict planes;
  for (const ResultPlane& plane : kResultPlanes) {
    if (plane.index >= kSolvedPlanes) break;
    const auto values = plane_of(forces, plane.index);
    if (values.empty()) continue;
    planes[plane.field().c_str()] = array_over(values.data(), shape, owner, false);
  }
  planes["status"] = array_over(forces.status.data(), shape, owner, false);
  return planes;
}

ForceCopy::ForceCopy(const ForceFieldView& forces)
    : status_(forces.status.begin(), forces.status.end()), view_(forces) {
  std::size_t values = 0;
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) values += plane_of(forces, i).size();
  values_.reserve(values);
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto plane = plane_of(forces, i);
    plane_of(view_, i) = {values_.data() + values_.size(), plane.size()};
    values_.insert(values_.end(), plane.begin(), plane.end());
  }
  view_.status = status_;
}

template <class T>
const T* ForceArrays::data_of(const py::dict& planes, const std::string& name) {
  if (!planes.contains(name.c_str())) return nullptr;
  const py::object given = planes[name.c_str()];
  const bool is_dense = py::isinstance<py::array_t<T, py::array::c_style>>(given);
  const auto array = is_dense ? py::array(given) : py::array();
  if (!is_dense || array.ndim() != 3 || array.shape(0) != static_cast<py::ssize_t>(frames_) ||
      array.shape(1) != rows_ || array.shape(2) != cols_) {
    throw Error("ForceField", "its plane " + name + " does not fit the others",
                "make a ForceField of planes of one shape");
  }
  arrays_.push_back(array);
  return static_cast<const T*>(array.data());
}

ForceArrays::ForceArrays(const py::dict& planes) {
  const py::array normal = planes.contains("normal") ? py::array(planes["normal"]) : py::array();
  if (normal.ndim() != 3 || normal.shape(1) > kMaxSensels || normal.shape(2) > kMaxSensels) {
    throw Error("ForceField", "it has no plane normal [frames, rows, cols]", "make one");
  }
  frames_ = static_cast<std::size_t>(normal.shape(0));
  rows_ = static_cast<std::uint32_t>(normal.shape(1));
  cols_ = static_cast<std::uint32_t>(normal.shape(2));
  for (const ResultPlane& plane : kResultPlanes) {
    if (plane.index >= kSolvedPlanes) break;
    planes_[plane.index] = data_of<float>(planes, plane.field());
  }
  status_ = data_of<std::uint8_t>(planes, "status");
  if (status_ == nullptr || (planes_[0] == nullptr) != (planes_[1] == nullptr)) {
    throw Error("ForceField", "a plane is missing",
                "give normal and status, and of pillars shear_x and shear_y");
  }
}

ForceFieldView ForceArrays::frame(std::size_t index) const {
  const std::size_t pillars = std::size_t{rows_} * cols_;
  ForceFieldView view;
  view.rows = rows_;
  view.cols = cols_;
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    if (planes_[i] != nullptr) plane_of(view, i) = {planes_[i] + index * pillars, pillars};
  }
  view.status = {status_ + index * pillars, pillars};
  return view;
}

}  // namespace pillarfield::python
