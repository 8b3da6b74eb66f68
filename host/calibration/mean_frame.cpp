#include "calibration/mean_frame.h"

#include <cmath>

namespace pillarfield {

FrameBuffer mean_frame(const FrameStatistics& frames) {
  const Skin& skin = frames.skin();
  FrameBuffer mean(SenselType::f32, skin.rows, skin.cols);
  const auto readings = mean.readings<float>();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const SenselStatistics& sensel = frames.sensels()[i];
    readings[i] = static_cast<float>(sensel.saturated > 0 ? *skin.full_scale_counts : sensel.mean);
    if (sensel.readings == 0) readings[i] = std::nanf("");
  }
  return mean;
}

}  // namespace pillarfield
