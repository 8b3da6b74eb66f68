#include "device/device_race.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace pillarfield {
namespace {

template <class Reading>
void press_rows(FrameBuffer& frame, std::uint32_t first, std::uint32_t count) {
  const std::size_t cols = frame.view().cols;
  std::ranges::fill(frame.readings<Reading>().subspan(first * cols, count * cols), Reading{128});
}

void press_rows(FrameBuffer& frame, std::uint32_t first, std::uint32_t count) {
  switch (frame.view().type) {
    case SenselType::u8:
      return press_rows<std::uint8_t>(frame, first, count);
    case SenselType::u16:
      return press_rows<std::uint16_t>(frame, first, count);
    case SenselType::f32:
      return press_rows<float>(frame, first, count);
  }
}

}  // namespace

double time_of_frame(const Device& device, const SolverPlan& plan) {
  constexpr std::uint32_t kFrames = 24;
  using Clock = std::chrono::steady_clock;
  std::vector<FrameBuffer> frames;  // Ends after the processor, which may still read it.
  Processor processor(device, plan);
  // Three frames for two slots: each slot gets another one than before.
  const std::uint32_t rows = plan.skin.rows / 12;
  for (std::uint32_t i = 0; i < 3; ++i) {
    press_rows(frames.emplace_back(processor.frame_buffer()), i * rows, rows);
  }
  std::vector<double> seconds;
  Clock::time_point before = Clock::now();
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    if (processor.in_flight() == 2) static_cast<void>(processor.receive());
    processor.submit(frames[i % frames.size()].view());
    const Clock::time_point now = Clock::now();
    seconds.push_back(std::chrono::duration<double>(now - std::exchange(before, now)).count());
  }
  while (processor.in_flight() > 0) static_cast<void>(processor.receive());
  std::ranges::nth_element(seconds, seconds.begin() + kFrames / 2);
  return seconds[kFrames / 2];
}

}  // namespace pillarfield
