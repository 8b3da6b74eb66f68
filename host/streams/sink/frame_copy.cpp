#include "streams/sink/frame_copy.h"

#include "solve/result_planes.h"

namespace pillarfield {
namespace {

std::size_t planes_to_copy(bool all_planes) { return all_planes ? kSolvedPlanes : kForcePlanes; }

/// An assignment of {} would keep the memory.
template <class Vector>
void release_memory(Vector& vector) {
  Vector().swap(vector);
}

}  // namespace

std::size_t bytes_of(const SolvedFrame& frame, const FrameParts& parts) {
  std::size_t bytes = frame.missing.size_bytes();
  if (parts.forces) {
    bytes += frame.forces.status.size();
    for (std::size_t plane = 0; plane < planes_to_copy(parts.all_planes); ++plane) {
      bytes += plane_of(frame.forces, plane).size_bytes();
    }
  }
  if (parts.contacts && frame.contacts != nullptr) {
    bytes += frame.contacts->contacts.size() * sizeof(TrackedContact) +
             frame.contacts->ended.size() * sizeof(EndedContact);
  }
  const FrameView& readings = frame.readings;
  if (parts.readings && readings.data != nullptr) {
    bytes += size_of(readings.type) * readings.rows * readings.cols;
  }
  return bytes;
}

void FrameCopy::assign(const SolvedFrame& frame, const FrameParts& parts) {
  frame_ = {};
  frame_.time_s = frame.time_s;
  frame_.sequence = frame.sequence;
  frame_.arrived = frame.arrived;
  missing_.assign(frame.missing.begin(), frame.missing.end());
  frame_.missing = missing_;
  if (parts.forces) copy_forces(frame.forces, parts.all_planes);
  if (parts.contacts && frame.contacts != nullptr) {
    contacts_ = *frame.contacts;
    frame_.contacts = &contacts_;
  }
  if (parts.readings && frame.readings.data != nullptr) copy_readings(frame.readings);
}

std::size_t FrameCopy::capacity() const {
  std::size_t bytes = status_.capacity() + readings_.capacity() +
                      missing_.capacity() * sizeof(SenselBlock) +
                      contacts_.contacts.capacity() * sizeof(TrackedContact) +
                      contacts_.ended.capacity() * sizeof(EndedContact);
  for (const std::vector<float>& plane : planes_) bytes += plane.capacity() * sizeof(float);
  return bytes;
}

void FrameCopy::release() {
  frame_ = {};
  contacts_ = FrameContacts();
  release_memory(planes_);
  release_memory(status_);
  release_memory(readings_);
  release_memory(missing_);
}

void FrameCopy::copy_forces(const ForceFieldView& forces, bool all_planes) {
  frame_.forces.rows = forces.rows;
  frame_.forces.cols = forces.cols;
  planes_.resize(planes_to_copy(all_planes));
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    const std::span<const float> values = plane_of(forces, plane);
    planes_[plane].assign(values.begin(), values.end());
    plane_of(frame_.forces, plane) = planes_[plane];
  }
  status_.assign(forces.status.begin(), forces.status.end());
  frame_.forces.status = status_;
}

void FrameCopy::copy_readings(const FrameView& readings) {
  readings_.resize(std::size_t{readings.rows} * readings.cols * size_of(readings.type));
  pillarfield::copy_readings(readings, readings_.data());
  frame_.readings = {readings_.data(), readings.type, readings.rows, readings.cols, readings.cols};
}

}  // namespace pillarfield
