#include "viewer/source/plane_block.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "pillarfield/status.h"
#include "viewer/source/field_producer.h"
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

void PeakHold::add(const ForceFieldView& forces) {
  if (peaks_.size() != forces.normal.size()) peaks_.assign(forces.normal.size(), 0);
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const float normal = forces.normal[i];
    if (normal > peaks_[i] && normal <= std::numeric_limits<float>::max()) peaks_[i] = normal;
  }
}

std::shared_ptr<const ShownField> PeakHold::field(const ShownField& frame) {
  if (!blocks_) {
    const SkinLayout layout = has_pillars(frame.forces) ? SkinLayout::pillars : SkinLayout::sensels;
    const std::uint32_t rows = frame.forces.rows;
    const std::uint32_t cols = frame.forces.cols;
    blocks_.emplace(FieldProducer::kMostShown,
                    [=] { return std::make_unique<PlaneBlock>(layout, rows, cols, false); });
  }
  const std::shared_ptr<PlaneBlock> block = blocks_->acquire();
  if (block == nullptr) return nullptr;
  std::ranges::copy(peaks_, block->plane(PlaneBlock::kNormal).begin());
  if (const std::span<float> magnitude = block->plane(PlaneBlock::kMagnitude); !magnitude.empty()) {
    std::ranges::copy(peaks_, magnitude.begin());
  }
  const std::uint8_t usable = has_pillars(frame.forces) ? status::kUsable : status::kSensel1;
  std::ranges::transform(peaks_, block->status().begin(),
                         [usable](float peak) { return peak > 0 ? usable : std::uint8_t{0}; });
  auto field = std::make_shared<ShownField>(frame);
  field->forces = block->view();
  field->raw = {};
  field->pages = block->pages();
  field->keep_alive = block;
  field->contacts = frame.contacts;
  return field;
}

}  // namespace pillarfield::viewer
