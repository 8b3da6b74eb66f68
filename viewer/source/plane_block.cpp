#include "viewer/source/plane_block.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "viewer/source/direction.h"

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kPageSize = 4096;
constexpr std::align_val_t kPage{kPageSize};

std::size_t whole_pages(std::size_t bytes) {
  return (bytes + kPageSize - 1) / kPageSize * kPageSize;
}

}  // namespace

void PlaneBlock::Free::operator()(std::byte* memory) const { ::operator delete[](memory, kPage); }

PlaneBlock::PlaneBlock(std::uint32_t rows, std::uint32_t cols, bool uncertainty)
    : rows_(rows),
      cols_(cols),
      planes_(kUncertainty + (uncertainty ? kUncertaintyPlanes : 0)),
      plane_bytes_(whole_pages(pillars() * sizeof(float))),
      bytes_(planes_ * plane_bytes_ + whole_pages(pillars())),
      pages_(static_cast<std::byte*>(::operator new[](bytes_, kPage))) {
  std::memset(pages_.get(), 0, bytes_);
}

float* PlaneBlock::place(std::size_t which) const {
  return reinterpret_cast<float*>(pages_.get() + which * plane_bytes_);
}

std::uint8_t* PlaneBlock::status_place() const {
  return reinterpret_cast<std::uint8_t*>(pages_.get() + planes_ * plane_bytes_);
}

std::span<float> PlaneBlock::plane(std::size_t which) {
  if (which >= planes_) return {};
  return {place(which), pillars()};
}

std::span<const float> PlaneBlock::plane(std::size_t which) const {
  if (which >= planes_) return {};
  return {place(which), pillars()};
}

std::span<std::uint8_t> PlaneBlock::status() { return {status_place(), pillars()}; }
std::span<const std::uint8_t> PlaneBlock::status() const { return {status_place(), pillars()}; }

void PlaneBlock::copy(const ForceFieldView& forces) {
  std::ranges::copy(forces.shear_x, plane(kShearX).begin());
  std::ranges::copy(forces.shear_y, plane(kShearY).begin());
  std::ranges::copy(forces.normal, plane(kNormal).begin());
  std::ranges::copy(forces.status, status().begin());
  std::size_t which = kUncertainty;
  for (const auto& from : forces.uncertainty) {
    const std::span<float> to = plane(which++);
    if (!to.empty()) std::ranges::copy(from, to.begin());
  }
  if (forces.magnitude.empty()) {
    set_directions(forces);
    return;
  }
  std::ranges::copy(forces.magnitude, plane(kMagnitude).begin());
  std::ranges::copy(forces.theta, plane(kTheta).begin());
  std::ranges::copy(forces.phi, plane(kPhi).begin());
}

void PlaneBlock::set_directions(const ForceFieldView& forces) {
  const std::span<float> magnitude = plane(kMagnitude);
  const std::span<float> theta = plane(kTheta);
  const std::span<float> phi = plane(kPhi);
  for (std::size_t i = 0; i < pillars(); ++i) {
    const Direction direction =
        direction_of(forces.shear_x[i], forces.shear_y[i], forces.normal[i]);
    magnitude[i] = direction.magnitude;
    theta[i] = direction.theta;
    phi[i] = direction.phi;
  }
}

ForceFieldView PlaneBlock::view() const {
  ForceFieldView view = {rows_,          cols_,    plane(kShearX),    plane(kShearY),
                         plane(kNormal), status(), plane(kMagnitude), plane(kTheta),
                         plane(kPhi),    {}};
  std::size_t which = kUncertainty;
  for (auto& span : view.uncertainty) span = plane(which++);
  return view;
}

}  // namespace pillarfield::viewer
