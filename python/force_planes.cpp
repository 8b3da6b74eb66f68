#include "python/force_planes.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

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

}  // namespace pillarfield::python
