// Prints the content of a file of frames as the library reads it, one item per line.
//
//     io_reader_process PATH
//
// Exit status 3: an Error, whose text is the last line printed.

#include <cstdio>
#include <span>

#include "pillarfield/error.h"
#include "pillarfield/recording.h"

namespace {

// NOLINTNEXTLINE(google-build-using-namespace): a program of that namespace
using namespace pillarfield;

template <class T>
void print_values(const char* name, std::span<const T> values) {
  std::printf("%s", name);
  for (const T value : values) std::printf(" %.9g", static_cast<double>(value));
  std::printf("\n");
}

void print_readings(const FrameBuffer& frame) {
  switch (frame.view().type) {
    case SenselType::u8:
      return print_values("raw", frame.readings<std::uint8_t>());
    case SenselType::u16:
      return print_values("raw", frame.readings<std::uint16_t>());
    case SenselType::f32:
      return print_values("raw", frame.readings<float>());
  }
}

void print_header(const FrameSource& source) {
  const Skin& skin = source.skin();
  std::printf("%s %u %u %s %llu\n", source.format().c_str(), skin.rows, skin.cols,
              name_of(source.sensel_type()), static_cast<unsigned long long>(source.frames()));
  std::printf("skin %.17g %.17g %.17g %.17g\n", skin.sensel_pitch_mm.col_mm, skin.counts_per_newton,
              skin.threshold_counts, skin.full_scale_counts.value_or(-1));
  const Calibration& calibration = source.calibration();
  print_values<float>("tare", calibration.tare);
  print_values<float>("gain", calibration.gain);
  print_values<float>("dead_zone", calibration.dead_zone);
  print_values<std::uint8_t>("mask", calibration.mask);
  for (const auto& warning : source.warnings()) std::printf("warning %s\n", warning.c_str());
}

void print_all(const char* path) {
  const auto source = open_frames(path);
  print_header(*source);
  const Skin& skin = source->skin();
  FrameBuffer frame(source->sensel_type(), skin.rows, skin.cols);
  ForceField truth;
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    std::printf("time %.17g\n", source->read(index, frame));
    print_readings(frame);
    if (!source->has_truth()) continue;
    source->read_truth(index, truth);
    print_values<float>("shear_x", truth.shear_x);
    print_values<float>("shear_y", truth.shear_y);
    print_values<float>("normal", truth.normal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    print_all(argv[1]);
  } catch (const pillarfield::Error& error) {
    std::printf("%s\n", error.what());
    return 3;
  }
  return 0;
}
