#include "skin/effect_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Collects the parameters of the effects that are set.
class ParameterWriter {
 public:
  explicit ParameterWriter(std::vector<EffectParameter>& parameters) : parameters_(parameters) {}

  template <class Effect, class Visit>
  void effect(const std::optional<Effect>& effect, Visit visit) {
    if (effect) visit(*effect);
  }
  void number(const char* name, double value) { parameters_.push_back({name, {value}, false}); }
  /// Only an offset is stored: conductance is what files without the parameter mean.
  void origin(const char* name, TareOrigin value) {
    if (value == TareOrigin::offset) number(name, 1);
  }
  void list(const char* name, const std::vector<double>& values) {
    if (!values.empty()) parameters_.push_back({name, values, true});
  }
  template <class Item>
  void list(const char* name, const std::vector<Item>& items, double Item::*member) {
    std::vector<double> values;
    values.reserve(items.size());
    for (const Item& item : items) values.push_back(item.*member);
    list(name, values);
  }

 private:
  std::vector<EffectParameter>& parameters_;
};

/// Sets the effects whose parameters are found.
class ParameterReader {
 public:
  using Find = std::function<std::optional<std::vector<double>>(const char*)>;
  ParameterReader(const Find& find, std::string_view where) : find_(find), where_(where) {}

  template <class Effect, class Visit>
  void effect(std::optional<Effect>& effect, Visit visit) {
    found_ = false;
    missing_ = nullptr;
    visit(effect.emplace());
    if (!found_) effect.reset();
    if (found_ && missing_ != nullptr) {
      throw Error(where_, fmt::format("has no '{}'", missing_),
                  "an effect needs all of its parameters");
    }
  }
  void number(const char* name, double& value) {
    const auto values = look_up(name);
    if (!values) {
      missing_ = name;
    } else if (values->size() != 1) {
      throw Error(where_, fmt::format("'{}' has {} values", name, values->size()), "store one");
    } else {
      value = values->front();
    }
  }
  void number(const char* name, std::uint32_t& value) {
    double read = 0;
    number(name, read);
    constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
    if (!(read >= 0 && read <= kMost && read == std::floor(read))) {
      throw Error(where_, fmt::format("'{}' is {}", name, read), "it must be a whole number");
    }
    value = static_cast<std::uint32_t>(read);
  }
  void origin(const char* name, TareOrigin& value) {
    const auto values = find_(name);
    if (!values) return;
    if (values->size() != 1 || (values->front() != 0 && values->front() != 1)) {
      throw Error(where_, fmt::format("'{}' is neither 0 nor 1", name),
                  "store 1 where tares are an offset, 0 where they conduct");
    }
    value = values->front() == 1 ? TareOrigin::offset : TareOrigin::conductance;
  }
  void list(const char* name, std::vector<double>& values) {
    values = look_up(name).value_or(std::vector<double>());
  }
  template <class Item>
  void list(const char* name, std::vector<Item>& items, double Item::*member) {
    const std::vector<double> values = look_up(name).value_or(std::vector<double>());
    if (items.empty()) items.resize(values.size());
    if (items.size() != values.size()) {
      throw Error(where_, fmt::format("'{}' has {} values", name, values.size()),
                  fmt::format("it needs {}, as many as its partner", items.size()));
    }
    for (std::size_t i = 0; i < items.size(); ++i) items[i].*member = values[i];
  }

 private:
  std::optional<std::vector<double>> look_up(const char* name) {
    auto values = find_(name);
    if (values) found_ = true;
    return values;
  }

  const Find& find_;
  std::string_view where_;
  bool found_ = false;
  const char* missing_ = nullptr;
};

/// Visits every parameter; `Effects` is const for a writer.
template <class Effects, class Visitor>
void visit(Effects& effects, Visitor& to) {
  to.list("curve_readings", effects.curve.readings);
  to.list("curve_loads", effects.curve.loads);
  to.effect(effects.shear_coefficient, [&](auto& shear) {
    to.number("shear_coefficient_x", shear.x);
    to.number("shear_coefficient_y", shear.y);
  });
  to.effect(effects.sensel_leak, [&](auto& leak) {
    to.number("leak_inside", leak.inside);
    to.number("leak_across", leak.across);
  });
  to.effect(effects.pillar_leak, [&](auto& leak) {
    to.number("pillar_leak_edge", leak.edge);
    to.number("pillar_leak_corner", leak.corner);
  });
  to.effect(effects.wires, [&](auto& wires) {
    to.number("wire_tile_rows", wires.tile_rows);
    to.number("wire_tile_cols", wires.tile_cols);
    to.number("wire_row_per_count", wires.row_per_count);
    to.number("wire_column_per_count", wires.column_per_count);
    to.number("wire_idle_per_count", wires.idle_per_count);
    to.origin("wire_tares_offset", wires.tares);
  });
  to.effect(effects.memory, [&](auto& memory) {
    to.list("play_widths_counts", memory.plays, &Play::width_counts);
    to.list("play_weights", memory.plays, &Play::weight);
    to.list("creep_times_s", memory.creep, &Creep::time_s);
    to.list("creep_weights", memory.creep, &Creep::weight);
  });
  to.effect(effects.arm_mm, [&](auto& arm) { to.number("arm_mm", arm); });
  to.effect(effects.residual, [&](auto& residual) {
    to.number("residual_relative", residual.relative);
    to.number("residual_offset_counts", residual.offset_counts);
  });
}

}  // namespace

std::vector<EffectParameter> parameters_of(const SensorEffects& effects) {
  std::vector<EffectParameter> parameters;
  ParameterWriter writer(parameters);
  visit(effects, writer);
  return parameters;
}

SensorEffects effects_of(
    const std::function<std::optional<std::vector<double>>(const char* name)>& find,
    std::string_view where) {
  SensorEffects effects;
  ParameterReader reader(find, where);
  visit(effects, reader);
  return effects;
}

}  // namespace pillarfield
