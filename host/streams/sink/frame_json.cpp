#include "streams/sink/frame_json.h"

#include <chrono>
#include <iterator>
#include <optional>

#include "base/number_text.h"

namespace pillarfield {
namespace {

void append_known(fmt::memory_buffer& json, const char* name, const std::optional<double>& value) {
  if (value) fmt::format_to(std::back_inserter(json), R"(,"{}":{})", name, json_number(*value));
}

/// The members of a contact or of the total.
void append_quantities(fmt::memory_buffer& json, const ContactQuantities& contact) {
  const auto out = std::back_inserter(json);
  if (contact.has_shear) {
    fmt::format_to(out, R"("force":{{"shear_x":{},"shear_y":{},"normal":{}}},"torque_nmm":{},)",
                   json_number(contact.shear_x_n), json_number(contact.shear_y_n),
                   json_number(contact.normal_n), json_number(contact.torque_nmm));
  } else {
    fmt::format_to(out, R"("force":{{"normal":{}}},"peak_pressure_kpa":{},)",
                   json_number(contact.normal_n), json_number(contact.peak_pressure_kpa()));
  }
  fmt::format_to(out, R"("{}":{},"centre_mm":{{"x":{},"y":{}}})",
                 contact.has_shear ? "pillars" : "sensels", contact.pillars,
                 json_number(contact.centre_of_pressure.x_mm),
                 json_number(contact.centre_of_pressure.y_mm));
  append_known(json, "friction", contact.friction);
  append_known(json, "friction_deviation", contact.friction_deviation);
  append_known(json, "slip_margin", contact.slip_margin);
  append_known(json, "slipping_share", contact.slipping_share);
  if (!contact.slip_forecast) return;
  const SlipForecast& forecast = *contact.slip_forecast;
  append_known(json, "time_to_slip_s", forecast.time_s);
  append_known(json, "time_to_slip_low_s", forecast.low_s);
  append_known(json, "time_to_slip_high_s", forecast.high_s);
  const auto& [soon, next, later] = forecast.probability;
  fmt::format_to(out, R"(,"slip_within_0_1_s":{},"slip_within_0_3_s":{},"slip_within_1_s":{})",
                 json_number(soon), json_number(next), json_number(later));
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
