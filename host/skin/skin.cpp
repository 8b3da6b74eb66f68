#include "pillarfield/skin.h"

#include <fmt/format.h>

#include <cmath>

#include "pillarfield/error.h"
#include "skin/limits.h"
#include "skin/skin_fields.h"

namespace pillarfield {

void check_range(std::string_view where, const NumberField& field, double value) {
  if (std::isfinite(value) && value >= field.low && value <= field.high) return;
  throw Error(where, fmt::format("{} is {}", field.name, value),
              fmt::format("it must lie in [{}, {}]", field.low, field.high));
}

std::size_t size_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return 1;
    case SenselType::u16:
      return 2;
    case SenselType::f32:
      break;
  }
  return 4;
}

const char* name_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "uint8";
    case SenselType::u16:
      return "uint16";
    case SenselType::f32:
      break;
  }
  return "float32";
}

const char* name_of(SkinLayout layout) { return name_in(kLayouts, layout); }

std::optional<SkinLayout> layout_named(std::string_view name) {
  const Named<SkinLayout>* const row = row_named(kLayouts, name);
  return row == nullptr ? std::nullopt : std::optional(row->value);
}

bool Skin::states_pitch() const {
  return stated.sensel_pitch || sensel_pitch_mm != Skin{}.sensel_pitch_mm;
}

bool Skin::states_counts_per_newton() const {
  return stated.counts_per_newton || counts_per_newton != Skin{}.counts_per_newton;
}

double straightened(const PowerLaw& law, double reading) {
  return law.reference_counts * std::pow(reading / law.reference_counts, law.exponent);
}

void check(const Skin& skin, std::string_view where) {
  const double least = skin.has_pillars() ? 2 : 1;
  check_range(where, {"rows", least, kMaxSensels}, skin.rows);
  check_range(where, {"cols", least, kMaxSensels}, skin.cols);
  if (!is_valid(skin.sensel_pitch_mm)) {
    throw Error(where, "sensel_pitch_mm is " + text_of(skin.sensel_pitch_mm),
                "it must lie in [0.001, 1000]");
  }
  if (skin.has_pillars() && !skin.sensel_pitch_mm.is_square()) {
    throw Error(where,
                fmt::format("a pitch of {} mm, and pillars need the same from row to row and from "
                            "column to column",
                            text_of(skin.sensel_pitch_mm)),
                "give one pitch, or the layout sensels");
  }
  visit_constants(skin, [&](const NumberField& field, const std::optional<double>& value) {
    if (value) check_range(where, field, *value);
  });
  for (const auto& [number, member] : kPowerLawFields) {
    if (skin.power_law) check_range(where, number, (*skin.power_law).*member);
  }
  if (skin.surface) check(*skin.surface, skin.element_grid(), where);
  if (skin.full_scale_counts && *skin.full_scale_counts <= skin.threshold_counts) {
    throw Error(where,
                fmt::format("full_scale_counts is {}, not above threshold_counts, {}",
                            *skin.full_scale_counts, skin.threshold_counts),
                "raise full_scale_counts or lower threshold_counts");
  }
}

std::vector<std::string> layout_warnings(const Skin& skin) {
  if (skin.stated.layout || !skin.has_pillars()) return {};
  return {
      "The skin states no layout and nothing states pillars: 2 x 2 sensels are taken as a pillar "
      "with shear; give layout='pillars', or layout='sensels' for each sensel by itself."};
}

}  // namespace pillarfield
