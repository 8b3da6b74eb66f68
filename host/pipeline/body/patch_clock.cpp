#include "pipeline/body/patch_clock.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pillarfield {
namespace {

constexpr double kWindowS = 0.5;
constexpr double kJumpS = 1;
/// Crystals differ by less; with few windows delays would look like drift.
constexpr double kMostDrift = 1e-3;
constexpr std::size_t kFewestWindows = 4;

}  // namespace

double PatchClock::seconds(std::uint64_t device_ns) const {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(device_ns - origin_ns_));
}

void PatchClock::add(std::uint64_t device_ns, Time arrived) {
  const double device_s = seconds(device_ns);
  const double ahead_s = 1e-9 * static_cast<double>((arrived - host_origin_).count()) - device_s;
  const double expected_s = offset_s_ + drift_ * (device_s - mean_s_);
  if (!started_ || device_s < window_began_s_ || std::abs(ahead_s - expected_s) > kJumpS) {
    *this = {};
    started_ = true;
    origin_ns_ = device_ns;
    host_origin_ = arrived;
    windows_ = 1;
    return;
  }
  Least& least = least_[(windows_ - 1) % kWindows];
  if (device_s - window_began_s_ >= kWindowS) {
    if (windows_ >= kFewestWindows) fit();
    window_began_s_ = device_s;
    least_[windows_++ % kWindows] = {device_s, ahead_s};
  } else if (ahead_s < least.ahead_s) {
    least = {device_s, ahead_s};
  }
  if (windows_ <= kFewestWindows) offset_s_ = std::min(offset_s_, ahead_s);
}

/// Fits the line to complete windows.
void PatchClock::fit() {
  const std::size_t count = std::min(windows_, kWindows);
  const std::span<const Least> all(least_.data(), count);
  mean_s_ = offset_s_ = 0;
  for (const Least& each : all) {
    mean_s_ += each.device_s / static_cast<double>(count);
    offset_s_ += each.ahead_s / static_cast<double>(count);
  }
  double square = 0;
  double product = 0;
  for (const Least& each : all) {
    square += (each.device_s - mean_s_) * (each.device_s - mean_s_);
    product += (each.device_s - mean_s_) * (each.ahead_s - offset_s_);
  }
  drift_ = std::clamp(product / square, -kMostDrift, kMostDrift);
}

PatchClock::Time PatchClock::host_time(std::uint64_t device_ns) const {
  const double device_s = seconds(device_ns);
  const double host_s = device_s + offset_s_ + drift_ * (device_s - mean_s_);
  return host_origin_ + Time(std::llround(1e9 * host_s));
}

}  // namespace pillarfield
