#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/field_study.h"

namespace pillarfield::report {

/// Iterations of the relaxation that are compared.
inline constexpr std::array kSweeps = {0, 1, 2, 4, 8, 16, 32, 64, 128};

/// Of a ratio or a share to mean something: ambiguous pillars in a scene.
inline constexpr std::size_t kEnoughPillars = 30;

/// The noise at which all is measured, counts.
inline constexpr double kTypicalNoise = 0.5;

/// How wrong a scene's ambiguous pillars are, by each way to resolve them.
struct SceneResult {
  field_study::Scene scene;
  field_study::Score middle;  ///< of the segment: the direct solve
  field_study::Score theta;   ///< the paper's midpoint
  field_study::Score best;    ///< the nearest that explains the readings: noise alone
  /// As field_study::methods(); those that no goal is about at kTypicalNoise alone.
  std::vector<std::optional<field_study::Score>> by_method;
  std::array<std::optional<field_study::Score>, kSweeps.size()> by_sweeps;  ///< at kTypicalNoise

  [[nodiscard]] const field_study::Score& field() const { return *by_method.front(); }
  [[nodiscard]] double ratio(std::size_t method = 0) const;  ///< to the paper's midpoint
  [[nodiscard]] bool counts() const { return theta.open >= kEnoughPillars; }
  /// Share of the loaded pillars that the readings determine.
  [[nodiscard]] double settled_share() const;
};

/// Solves scenes that have their loads by all methods and sweeps, or by the first method alone.
[[nodiscard]] std::vector<SceneResult> results_of(const std::vector<field_study::Scene>& scenes,
                                                  bool all_methods);

/// Scores of many scenes, their pillars taken together.
struct Pooled {
  field_study::Score middle;
  field_study::Score theta;
  field_study::Score best;
  field_study::Score solved;
  std::size_t scenes = 0;

  void add(const SceneResult& result, const field_study::Score& score);
  [[nodiscard]] double ratio() const;       ///< of `solved` to `theta`
  [[nodiscard]] double best_ratio() const;  ///< of `best` to `theta`
};

/// Kinds of scenes, as tables have them: "rounded, spin" and so on, in their order.
struct Kind {
  std::string name;
  std::function<bool(const field_study::Scene&)> holds;
};
[[nodiscard]] const std::vector<Kind>& kinds();

/// Of the scenes for which `holds`; `score_of` gives nothing where a scene shall not count.
[[nodiscard]] Pooled pool(
    const std::vector<SceneResult>& results, const std::function<bool(const SceneResult&)>& holds,
    const std::function<std::optional<field_study::Score>(const SceneResult&)>& score_of);

/// The same for a method, at all noises or only at the typical one.
[[nodiscard]] Pooled pool_method(const std::vector<SceneResult>& results, const Kind& kind,
                                 std::size_t method, bool typical_noise = false);

/// "0.093"; "–" where no scene counts.
[[nodiscard]] std::string ratio_text(const Pooled& pooled);

}  // namespace pillarfield::report
