#include "base/energy_meter.h"

#include <fstream>
#include <string>
#include <system_error>

namespace pillarfield {
namespace {

template <class Value>
std::optional<Value> read(const std::filesystem::path& file) {
  std::ifstream text(file);
  Value value;
  if (text >> value) return value;
  return std::nullopt;
}

/// A zone of powercap is a package, a part of one, or, as "psys", the computer with its packages.
bool is_package(const std::filesystem::path& zone) {
  return zone.filename().string().starts_with("intel-rapl:") &&
         read<std::string>(zone / "name").value_or("").starts_with("package");
}

}  // namespace

EnergyMeter::EnergyMeter(const std::filesystem::path& powercap) {
  std::error_code absent;
  for (const auto& zone : std::filesystem::directory_iterator(powercap, absent)) {
    if (!is_package(zone.path())) continue;
    const auto counter = zone.path() / "energy_uj";
    const auto range_uj = read<double>(zone.path() / "max_energy_range_uj");
    const auto now_uj = read<double>(counter);
    if (range_uj && now_uj) packages_.push_back({counter, *range_uj, *now_uj});
  }
}

std::optional<double> EnergyMeter::joules() {
  for (Package& package : packages_) {
    const auto now_uj = read<double>(package.counter);
    if (!now_uj) {
      packages_.clear();
      break;
    }
    const double used_uj = *now_uj - package.last_uj;
    joules_ += 1e-6 * (used_uj < 0 ? used_uj + package.range_uj : used_uj);
    package.last_uj = *now_uj;
  }
  if (packages_.empty()) return std::nullopt;
  return joules_;
}

}  // namespace pillarfield
