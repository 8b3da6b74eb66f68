#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/recording.h"

namespace pillarfield::io_test {

/// The readings of all frames as floats.
inline std::vector<float> all_readings(FrameSource& source) {
  std::vector<float> all;
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    source.read(index, frame);
    const auto append = [&](const auto& readings) {
      for (const auto reading : readings) all.push_back(static_cast<float>(reading));
    };
    if (source.sensel_type() == SenselType::u8) append(frame.readings<std::uint8_t>());
    if (source.sensel_type() == SenselType::u16) append(frame.readings<std::uint16_t>());
    if (source.sensel_type() == SenselType::f32) append(frame.readings<float>());
  }
  return all;
}

}  // namespace pillarfield::io_test
