#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace pillarfield {

/// Leaks in the order inside, across, edge, corner.
using Leaks = std::array<double, 4>;

/// 6 x 6 sensels: a pressed pillar in the middle of 3 x 3.
using SenselPatch = std::array<double, 36>;
inline constexpr std::size_t kPatchSide = 6;

/// Sensels 1 to 4 of the pressed pillar in a patch.
inline constexpr std::array<std::size_t, 4> kPressedSensels = {15, 14, 20, 21};

/// V of the pressed pillar's sensels.
using PressedLoad = std::array<double, 4>;

/// Readings of a patch under a load, and their derivatives by the leaks. Sensels read V above the
/// dead zone `zone`, counts.
struct LeakedPatch {
  SenselPatch readings;
  std::array<SenselPatch, 4> derivatives;
};
[[nodiscard]] LeakedPatch leak_patch(const PressedLoad& load, const Leaks& leaks, double zone);

/// The sensel, 0 to 3, that carries no load: the smaller one of the diagonal whose sum exceeds the
/// other one's by `margin`. Unset if neither does.
[[nodiscard]] std::optional<std::size_t> inactive_sensel(const PressedLoad& readings,
                                                         double margin);

/// V of the pressed pillar from its own readings; zero for the `inactive` sensel.
[[nodiscard]] PressedLoad unleak(const PressedLoad& readings, const Leaks& leaks, double zone,
                                 const std::optional<std::size_t>& inactive);

}  // namespace pillarfield
