#include "skin/effect_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "pillarfield/error.h"
#include "skin/limits.h"

namespace pillarfield {
namespace {

/// Collects the parameters of the effects that are set.
class ParameterWriter {
 public:
  explicit ParameterWriter(std::vector<EffectParameter>& parameters) : parameters_(parameters) {}

  template <class Effect, class Visit>
  void effect(const char* name, const Effect& effect, Visit visit) {
    effect_ = name;
    visit(effect);
  }
  template <class Effect, class Visit>
  void effect(const char* name, const std::optional<Effect>& effect, Visit visit) {
    effect_ = name;
    if (effect) visit(*effect);
  }
  void number(const char* name, double value, const Range& range) {
    parameters_.push_back({effect_, name, range, {value}, false});
  }
  /// Only an offset is stored: conductance is what files without the parameter mean.
  void origin(const char* name, TareOrigin value) {
    if (value == TareOrigin::offset) number(name, 1, {0, 1});
  }
  void list(const char* name, const std::vector<double>& values, const Range& range) {
    if (!values.empty()) parameters_.push_back({effect_, name, range, values, true});
  }
  template <class Item>
  void list(const char* name, const std::vector<Item>& items, double Item::*member,
            const Range& range) {
    std::vector<double> values;
    values.reserve(items.size());
    for (const Item& item : items) values.push_back(item.*member);
    list(name, values, range);
  }

 private:
  std::vector<EffectParameter>& parameters_;
  const char* effect_ = "";
};

/// Sets the effects whose parameters are found.
class ParameterReader {
 public:
  ParameterReader(const FindParameter& find, std::string_view where, bool all_needed)
      : find_(find), where_(where), all_needed_(all_needed) {}

  template <class Effect, class Visit>
  void effect(const char* name, Effect& effect, Visit visit) {
    effect_ = name;
    visit(effect);
  }
  template <class Effect, class Visit>
  void effect(const char* name, std::optional<Effect>& effect, Visit visit) {
    effect_ = name;
    found_ = false;
    missing_ = nullptr;
    visit(effect.emplace());
    if (!found_) effect.reset();
    if (found_ && missing_ != nullptr && all_needed_) {
      throw Error(where_, fmt::format("has no '{}'", missing_),
                  "an effect needs all of its parameters");
    }
  }
  void number(const char* name, double& value, const Range& range) {
    const auto values = look_up(name, range);
    if (!values) {
      missing_ = name;
    } else if (values->size() != 1) {
      throw Error(where_, fmt::format("'{}' has {} values", name, values->size()), "store one");
    } else {
      value = values->front();
    }
  }
  void number(const char* name, std::uint32_t& value, const Range& range) {
    double read = value;
    number(name, read, range);
    constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
    if (!(read >= 0 && read <= kMost && read == std::floor(read))) {
      throw Error(where_, fmt::format("'{}' is {}", name, read), "it must be a whole number");
    }
    value = static_cast<std::uint32_t>(read);
  }
  void origin(const char* name, TareOrigin& value) {
    const auto values = find_({effect_, name, {0, 1}});
    if (!values) return;
    if (values->size() != 1 || (values->front() != 0 && values->front() != 1)) {
      throw Error(where_, fmt::format("'{}' is neither 0 nor 1", name),
                  "store 1 where tares are an offset, 0 where they conduct");
    }
    value = values->front() == 1 ? TareOrigin::offset : TareOrigin::conductance;
  }
  void list(const char* name, std::vector<double>& values, const Range& range) {
    values = look_up(name, range).value_or(std::vector<double>());
  }
  template <class Item>
  void list(const char* name, std::vector<Item>& items, double Item::*member, const Range& range) {
    const std::vector<double> values = look_up(name, range).value_or(std::vector<double>());
    if (items.empty()) items.resize(values.size());
    if (items.size() != values.size()) {
      throw Error(where_, fmt::format("'{}' has {} values", name, values.size()),
                  fmt::format("it needs {}, as many as its partner", items.size()));
    }
    for (std::size_t i = 0; i < items.size(); ++i) items[i].*member = values[i];
  }

 private:
  std::optional<std::vector<double>> look_up(const char* name, const Range& range) {
    auto values = find_({effect_, name, range});
    if (values) found_ = true;
    return values;
  }

  const FindParameter& find_;
  std::string_view where_;
  bool all_needed_;
  const char* effect_ = "";
  bool found_ = false;
  const char* missing_ = nullptr;
};

// Ranges that nothing else needs.
constexpr Range kSenselLeak = {-kMostSenselLeak, kMostSenselLeak};
constexpr Range kPillarLeak = {-kMostPillarLeak / 4, kMostPillarLeak / 4};
constexpr Range kPerCount = {0, 0.1};
constexpr Range kPlayWeight = {-1, 1};
constexpr Range kCreepTimeS = {1e-6, 1e9};
constexpr Range kCreepWeight = {-0.5, 0.5};
constexpr Range kWholeCounts = {0, kCurveCounts.high};

/// The one table of effects and their parameters; `Effects` is const for a writer.
template <class Effects, class Visitor>
void visit(Effects& effects, Visitor& to) {
  to.effect("curve", effects.curve, [&](auto& curve) {
    to.list("curve_readings", curve.readings, kCurveCounts);
    to.list("curve_loads", curve.loads, kCurveCounts);
  });
  to.effect("shear_coefficient", effects.shear_coefficient, [&](auto& shear) {
    to.number("shear_coefficient_x", shear.x, kShearCoefficient);
    to.number("shear_coefficient_y", shear.y, kShearCoefficient);
  });
  to.effect("sensel_leak", effects.sensel_leak, [&](auto& leak) {
    to.number("leak_inside", leak.inside, kSenselLeak);
    to.number("leak_across", leak.across, kSenselLeak);
  });
  to.effect("pillar_leak", effects.pillar_leak, [&](auto& leak) {
    to.number("pillar_leak_edge", leak.edge, kPillarLeak);
    to.number("pillar_leak_corner", leak.corner, kPillarLeak);
  });
  to.effect("wires", effects.wires, [&](auto& wires) {
    to.number("wire_tile_rows", wires.tile_rows, kTileSensels);
    to.number("wire_tile_cols", wires.tile_cols, kTileSensels);
    to.number("wire_row_per_count", wires.row_per_count, kPerCount);
    to.number("wire_column_per_count", wires.column_per_count, kPerCount);
    to.number("wire_idle_per_count", wires.idle_per_count, kPerCount);
    to.origin("wire_tares_offset", wires.tares);
  });
  to.effect("memory", effects.memory, [&](auto& memory) {
    to.list("play_widths_counts", memory.plays, &Play::width_counts, kWholeCounts);
    to.list("play_weights", memory.plays, &Play::weight, kPlayWeight);
    to.list("creep_times_s", memory.creep, &Creep::time_s, kCreepTimeS);
    to.list("creep_weights", memory.creep, &Creep::weight, kCreepWeight);
  });
  to.effect("arm", effects.arm_mm, [&](auto& arm) { to.number("arm_mm", arm, kPillarArmMm); });
  to.effect("residual", effects.residual, [&](auto& residual) {
    to.number("residual_relative", residual.relative, {0, 1});
    to.number("residual_offset_counts", residual.offset_counts, kWholeCounts);
  });
}

}  // namespace

std::vector<EffectParameter> parameters_of(const SensorEffects& effects) {
  std::vector<EffectParameter> parameters;
  ParameterWriter writer(parameters);
  visit(effects, writer);
  return parameters;
}

std::vector<std::string> names_of(const SensorEffects& effects) {
  std::vector<std::string> names;
  for (const EffectParameter& parameter : parameters_of(effects)) {
    if (names.empty() || names.back() != parameter.effect) names.emplace_back(parameter.effect);
  }
  return names;
}

bool SensorEffects::empty() const { return parameters_of(*this).empty(); }

SensorEffects effects_of(const FindParameter& find, std::string_view where, bool all_needed) {
  SensorEffects effects;
  ParameterReader reader(find, where, all_needed);
  visit(effects, reader);
  return effects;
}

}  // namespace pillarfield
