#include "streams/sink/frame_json.h"

#include <chrono>
#include <iterator>

namespace pillarfield {
namespace {

/// The members of a contact or of the total.
void append_quantities(fmt::memory_buffer& json, const ContactQuantities& contact) {
  const auto out = std::back_inserter(json);
  if (contact.has_shear) {
    fmt::format_to(out, R"("force":{{"shear_x":{},"shear_y":{},"normal":{}}},"torque_nmm":{},)",
                   contact.shear_x_n, contact.shear_y_n, contact.normal_n, contact.torque_nmm);
  } else {
    fmt::format_to(out, R"("force":{{"normal":{}}},"peak_pressure_kpa":{},)", contact.normal_n,
                   contact.peak_pressure_kpa());
  }
  fmt::format_to(out, R"("{}":{},"centre_mm":{{"x":{},"y":{}}})",
                 contact.has_shear ? "pillars" : "sensels", contact.pillars,
                 contact.centre_of_pressure.x_mm, contact.centre_of_pressure.y_mm);
  if (contact.friction) {
    fmt::format_to(std::back_inserter(json), R"(,"friction":{})", *contact.friction);
  }
  if (contact.slip_margin) {
    fmt::format_to(std::back_inserter(json), R"(,"slip_margin":{})", *contact.slip_margin);
  }
  if (contact.slip_forecast && contact.slip_forecast->time_s) {
    fmt::format_to(std::back_inserter(json), R"(,"time_to_slip_s":{})",
                   *contact.slip_forecast->time_s);
  }
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
                 frame.time_s, frame.sequence);
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
