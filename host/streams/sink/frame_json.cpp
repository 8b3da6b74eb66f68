#include "streams/sink/frame_json.h"

#include <chrono>
#include <cmath>
#include <iterator>

#include "base/number_text.h"
#include "pillarfield/contact_columns.h"

namespace pillarfield {
namespace {

/// The members of a contact or of the total, as far as they are known. A path "force.normal" is a
/// member of an object, whose members follow each other.
void append_quantities(fmt::memory_buffer& json, const ContactQuantities& contact) {
  const auto out = std::back_inserter(json);
  const SkinLayout layout = contact.has_shear ? SkinLayout::pillars : SkinLayout::sensels;
  std::string_view open;
  const char* separator = "";
  for (const QuantityColumn& column : quantity_columns(false, layout)) {
    std::string_view path = column.live.path;
    const double value = column.get(contact);
    if (path.empty() || std::isnan(value)) continue;
    const std::string_view object = path.substr(0, path.find('.') + 1);
    path.remove_prefix(object.size());
    if (object != open) {
      if (!open.empty()) json.push_back('}');
      if (!object.empty()) {
        fmt::format_to(out, R"({}"{}":{{)", separator, object.substr(0, object.size() - 1));
        separator = "";
      }
      open = object;
    }
    fmt::format_to(
        out, R"({}"{}":{})", separator, path,
        column.kind == ColumnKind::number ? json_number(value) : fmt::format("{:.0f}", value));
    separator = ",";
  }
  if (!open.empty()) json.push_back('}');
}

}  // namespace

FrameJson::FrameJson(const LiveSinkInfo& info) {
  ContactOptions options;
  options.layout = info.forces.layout;
  if (!info.forces.contacts) tracker_.emplace(info.forces.element_pitch_mm, options);
}

std::string_view FrameJson::line(const SolvedFrame& frame) {
  if (frame.contacts == nullptr && !tracker_) return {};
  const FrameContacts& contacts =
      frame.contacts != nullptr ? *frame.contacts : tracker_->update(frame.forces, frame.time_s);
  const double stamp_s = std::chrono::duration<double>(clock_.real_time(frame.arrived)).count();
  json_.clear();
  fmt::format_to(std::back_inserter(json_),
                 R"({{"timestamp":{:.9f},"time":{},"sequence":{},"total":{{)", stamp_s,
                 json_number(frame.time_s), frame.sequence);
  append_quantities(json_, contacts.total);
  json_.append(std::string_view(R"(},"contacts":{)"));
  std::size_t listed = 0;
  const auto& slots = slots_.update(contacts);
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (slots[slot].contact == nullptr) continue;
    fmt::format_to(std::back_inserter(json_), R"({}"{}":{{"id":{},)", listed++ > 0 ? "," : "",
                   slot + 1, slots[slot].contact->track_id);
    append_quantities(json_, slots[slot].contact->quantities);
    json_.push_back('}');
  }
  fmt::format_to(std::back_inserter(json_), R"(}},"contacts_omitted":{}}})",
                 contacts.contacts.size() - listed);
  return {json_.data(), json_.size()};
}

}  // namespace pillarfield
