#include "viewer/app/load_range.h"

#include "viewer/app/input/actions.h"

namespace pillarfield::viewer {

void LoadFollower::take_field(AppState& state) {
  if (!follows_) return;
  const Skin& skin = state.player->info().skin;
  RenderSettings& settings = state.settings;
  if (quantity_ == settings.quantity && range_ != settings.range) follows_ = false;
  const auto load = load_.add(state.field->time_s, largest(Quantity::normal, *state.field, skin));
  if (load && follows_ && !state.fit_each_field) {
    const float most = 1.2F * *load;
    const Range range = fitting_range(Quantity::normal, most);
    settings.full_force_n = settings.full_shear_n = static_cast<double>(*load) / 2;
    settings.relief_full_n = static_cast<double>(range.high);
    if (settings.quantity == Quantity::normal) set_range(state, range);
    if (settings.quantity == Quantity::pressure) {
      set_range(state, fitting_range(Quantity::pressure, most * kpa_per_newton(skin)));
    }
  }
  quantity_ = settings.quantity;
  range_ = settings.range;
}

}  // namespace pillarfield::viewer
