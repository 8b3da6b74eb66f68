#include "viewer/source/plane_block.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kPageSize = 4096;
constexpr std::align_val_t kPage{kPageSize};

std::size_t whole_pages(std::size_t bytes) {
  return (bytes + kPageSize - 1) / kPageSize * kPageSize;
}

constexpr std::size_t kFirstUncertainty = PlaneBlock::kPhi + 1;

template <class Field>
auto& plane_of(Field& field, std::size_t index) {
  constexpr std::array kNamed{&ForceFieldView::shear_x, &ForceFieldView::shear_y,
                              &ForceFieldView::normal,  &ForceFieldView::magnitude,
                              &ForceFieldView::theta,   &ForceFieldView::phi};
  if (index < kFirstUncertainty) return field.*kNamed[index];
  return field.uncertainty[static_cast<Uncertainty>(index - kFirstUncertainty)];
}

/// Sensels have only the normal force and its deviation.
bool has_plane(SkinLayout layout, bool uncertainty, std::size_t index) {
  if (index >= kFirstUncertainty && !uncertainty) return false;
  return layout == SkinLayout::pillars || index == PlaneBlock::kNormal ||
         index == kFirstUncertainty + static_cast<std::size_t>(Uncertainty::normal);
}

}  // namespace

void PlaneBlock::Free::operator()(std::byte* memory) const { ::operator delete[](memory, kPage); }

PlaneBlock::PlaneBlock(SkinLayout layout, std::uint32_t rows, std::uint32_t cols, bool uncertainty)
    : rows_(rows), cols_(cols), plane_bytes_(whole_pages(elements() * sizeof(float))) {
  for (std::size_t i = 0; i < kPlanes; ++i) {
    places_[i] = has_plane(layout, uncertainty, i) ? planes_++ : kAbsentPlane;
  }
  bytes_ = planes_ * plane_bytes_ + whole_pages(elements());
  pages_.reset(static_cast<std::byte*>(::operator new[](bytes_, kPage)));
  std::memset(pages_.get(), 0, bytes_);
}

std::span<float> PlaneBlock::plane(std::size_t which) const {
  const std::size_t place = places_.at(which);
  if (place == kAbsentPlane) return {};
  return {reinterpret_cast<float*>(pages_.get() + place * plane_bytes_), elements()};
}

std::span<std::uint8_t> PlaneBlock::status() const {
  return {reinterpret_cast<std::uint8_t*>(pages_.get() + planes_ * plane_bytes_), elements()};
}

void PlaneBlock::copy(const ForceFieldView& forces) {
  for (std::size_t i = 0; i < kPlanes; ++i) {
    const std::span<const float> from = plane_of(forces, i);
    const std::span<float> to = plane(i);
    if (!to.empty()) std::ranges::copy(from, to.begin());
  }
  std::ranges::copy(forces.status, status().begin());
  if (forces.magnitude.empty() && !plane(kMagnitude).empty()) set_directions(forces);
}

void PlaneBlock::set_directions(const ForceFieldView& forces) {
  const std::span<float> magnitude = plane(kMagnitude);
  const std::span<float> theta = plane(kTheta);
  const std::span<float> phi = plane(kPhi);
  for (std::size_t i = 0; i < elements(); ++i) {
    const Direction direction =
        direction_of(forces.shear_x[i], forces.shear_y[i], forces.normal[i]);
    magnitude[i] = direction.magnitude;
    theta[i] = direction.theta;
    phi[i] = direction.phi;
  }
}

ForceFieldView PlaneBlock::view() const {
  ForceFieldView view;
  view.rows = rows_;
  view.cols = cols_;
  view.status = status();
  for (std::size_t i = 0; i < kPlanes; ++i) plane_of(view, i) = plane(i);
  return view;
}

}  // namespace pillarfield::viewer
