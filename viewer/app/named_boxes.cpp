#include "viewer/app/named_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "pillarfield/printable.h"

namespace pillarfield::viewer {

bool is_box_name(std::string_view name) {
  return name.size() <= NamedBox::kMostNameBytes && printable(name) == name &&
         name.find_first_not_of(' ') != std::string_view::npos;
}

NamedBoxes::Size NamedBoxes::size_of(const Skin& skin) {
  return {skin.element_rows(), skin.element_cols(), skin.layout};
}

std::vector<NamedBox> NamedBoxes::on(const Skin& skin) const {
  const auto found = std::ranges::find(sizes_, size_of(skin), &Sized::size);
  return found == sizes_.end() ? std::vector<NamedBox>{} : found->boxes;
}

void NamedBoxes::set(const Skin& skin, std::vector<NamedBox> boxes) {
  const Size size = size_of(skin);
  std::erase_if(sizes_, [&](const Sized& each) { return each.size == size; });
  if (boxes.empty()) return;
  for (NamedBox& box : boxes) box.cached.reset();  // Another source has other sums.
  sizes_.insert(sizes_.begin(), {size, std::move(boxes)});
  if (sizes_.size() > kMostSizes) sizes_.pop_back();
}

std::string NamedBoxes::text() const {
  std::string text;
  for (const auto& [size, boxes] : sizes_) {
    for (const NamedBox& box : boxes) {
      text += fmt::format("box {} {} {} {} {} {} {} {}\n", size.rows, size.cols,
                          name_of(size.layout), box.rect.row_begin, box.rect.row_end,
                          box.rect.col_begin, box.rect.col_end, box.name);
    }
  }
  return text;
}

void NamedBoxes::add_line(const std::string& line) {
  std::istringstream words(line);
  std::string head;
  std::string layout;
  Size size;
  NamedBox box;
  PillarRect& rect = box.rect;
  words >> head >> size.rows >> size.cols >> layout >> rect.row_begin >> rect.row_end >>
      rect.col_begin >> rect.col_end;
  if (head != "box" || !words || words.get() != ' ') return;
  std::getline(words, box.name);
  const auto known = layout_named(layout);
  const bool inside = rect.row_begin < rect.row_end && rect.row_end <= size.rows &&
                      rect.col_begin < rect.col_end && rect.col_end <= size.cols;
  if (!known || !inside || !is_box_name(box.name)) return;
  size.layout = *known;
  auto found = std::ranges::find(sizes_, size, &Sized::size);
  if (found == sizes_.end()) {
    if (sizes_.size() == kMostSizes) return;
    found = sizes_.insert(sizes_.end(), Sized{size, {}});
  }
  if (found->boxes.size() == kMost) return;
  box.number = static_cast<int>(found->boxes.size()) + 1;
  found->boxes.push_back(std::move(box));
}

}  // namespace pillarfield::viewer
