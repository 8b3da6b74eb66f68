#include "io/skin_constants.h"

#include <fmt/format.h>

#include <initializer_list>
#include <utility>

#include "pillarfield/layout_note.h"

namespace pillarfield {
namespace {

using NamedOption = std::pair<const char*, bool>;

std::vector<std::string> names_given(std::initializer_list<NamedOption> options) {
  std::vector<std::string> names;
  for (const auto& [name, is_given] : options) {
    if (is_given) names.emplace_back(name);
  }
  return names;
}

}  // namespace

void take_constants(Skin& skin, const StoredSkin& stated, const ReadOptions& options) {
  const auto take = [](auto& constant, const auto& given, const auto& known) {
    constant = given.value_or(known.value_or(constant));
    return given || known;
  };
  skin.stated = {options.layout || stated.layout,
                 take(skin.sensel_pitch_mm, options.sensel_pitch_mm, stated.sensel_pitch_mm),
                 take(skin.counts_per_newton, options.counts_per_newton, stated.counts_per_newton)};
  take(skin.threshold_counts, options.threshold_counts, stated.threshold_counts);
  skin.full_scale_counts =
      options.full_scale_counts ? options.full_scale_counts : stated.full_scale_counts;
  skin.power_law = stated.power_law;
  skin.layout = options.layout.value_or(stated.layout.value_or(SkinLayout::sensels));
  skin.falling = options.falling || stated.falling;
}

std::vector<std::string> given_file_options(const ReadOptions& options) {
  return names_given({{"--dataset", !options.dataset.empty()},
                      {"--times", !options.times.empty()},
                      {"--shape", options.frame_size.has_value()},
                      {"--columns", !options.columns.empty()},
                      {"--where", !options.where.empty()},
                      {"--axes", !options.axes.empty()},
                      {"--rate", options.rate_hz.has_value()},
                      {"--tare-frames", options.tare_frames > 0}});
}

std::string layout_note(const Skin& skin) {
  return skin.has_pillars()
             ? "2 x 2 sensels are a pillar with shear (--layout sensels: each by itself)"
             : "each sensel by itself, without shear (--layout pillars: 2 x 2 are a pillar)";
}

std::string assumption_note(const Skin& skin) {
  std::string note = skin.stated.layout ? "" : layout_note(skin);
  const auto add = [&](const std::string& words) { note += (note.empty() ? "" : "; ") + words; };
  if (!skin.states_pitch()) {
    add(fmt::format("pitch {:.3g} mm assumed (--pitch-mm)", skin.sensel_pitch_mm.col_mm));
  }
  if (!skin.states_counts_per_newton()) {
    add(fmt::format("{:g} counts per newton assumed (--counts-per-newton)",
                    skin.counts_per_newton));
  }
  return note;
}

}  // namespace pillarfield
