// Speed of the viewer's drawing.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "bench/cases/cases.h"
#include "bench/frames.h"
#include "bench/session.h"
#include "bench/timing/measurement.h"
#include "bench/timing/unsuffixed_reporter.h"
#include "bench/variants.h"
#include "pillarfield/error.h"
#include "viewer/options.h"
#include "viewer/render/renderer.h"
#include "viewer/source/frame_provider.h"
#include "viewer/source/solved_producer.h"

namespace pillarfield::bench {
namespace {

/// The viewer's pictures of a square skin, a tenth of it in contact, without a window. Its frames
/// are solved beforehand.
class Pictures {
 public:
  static constexpr std::uint32_t kWidth = 1280;
  static constexpr std::uint32_t kHeight = 720;

  struct Kind {
    std::uint32_t pillars_a_side;
    bool orbit;     ///< perspective, else from above
    bool arrows;    ///< on the heat map
    bool overlay;   ///< axes and legends
    bool in_place;  ///< reads fields in the solver's memory, else copies them to the device
  };

  /// Throws an Error that begins with kSkipped where no Vulkan device suffices.
  Pictures(const Device& solver, const Kind& kind);

  /// Draws `pictures` pictures of the next fields; waits for each.
  void draw(int pictures);

  /// Clears a target and reads it back, `pictures` times.
  void clear_and_read(int pictures);

  /// Reads the last picture back, `pictures` times.
  void read(int pictures);

  [[nodiscard]] const std::string& device_name() const { return device_.name(); }

 private:
  viewer::gpu::Instance instance_;
  viewer::gpu::Device device_;
  std::unique_ptr<viewer::FieldProducer> producer_;
  std::vector<viewer::ShownField> fields_;
  viewer::RenderSettings settings_;
  viewer::Renderer renderer_;
  vk::raii::RenderPass nothing_;
  viewer::Target target_;
  std::size_t drawn_ = 0;
};

constexpr double kContact = 0.1;
constexpr std::uint64_t kFields = 4;  ///< of a square metre: larger than the caches

/// Copies of the benchmark's frames.
class FrameCopies final : public viewer::FrameProvider {
 public:
  FrameCopies(const SolverPlan& plan, std::uint64_t count) {
    const Frames frames(plan.skin, plan.sensel_type, {Touch::mixed, kContact});
    for (std::uint64_t i = 0; i < count; ++i) {
      auto copy = std::make_shared<FrameBuffer>(plan.sensel_type, plan.skin.rows, plan.skin.cols);
      std::memcpy(copy->bytes().data(), frames[i].data, copy->bytes().size());
      frames_.push_back({std::move(copy), 0});
    }
  }
  [[nodiscard]] std::uint64_t frames() const override { return frames_.size(); }
  [[nodiscard]] viewer::FrameHandle frame(std::uint64_t index) override {
    return frames_.at(index);
  }

 private:
  std::vector<viewer::FrameHandle> frames_;
};

std::unique_ptr<viewer::FieldProducer> make_producer(const Device& solver, std::uint32_t side) {
  const SolverPlan plan = viewer::shown_plan(bare_plan(side));
  viewer::SourceInfo info;
  info.name = "frames of the benchmark";
  info.kind = "recording";
  info.skin = plan.skin;
  info.has_readings = true;
  info.has_angles = true;
  return std::make_unique<viewer::SolvedProducer>(
      info, std::make_unique<FrameCopies>(plan, kFields), plan,
      Processor(solver, plan, {.frames_in_flight = viewer::FieldProducer::kMostShown}));
}

viewer::RenderSettings settings_of(viewer::FieldProducer& producer, const Pictures::Kind& kind) {
  viewer::Options options;
  options.orbit = kind.orbit;
  options.look.arrows = kind.arrows;
  options.look.legend = kind.overlay;
  viewer::RenderSettings settings = viewer::default_settings(options, producer, 1);
  const viewer::Layout layout = viewer::layout_of(Pictures::kWidth, Pictures::kHeight, settings);
  settings.view = viewer::first_view(options, producer.info(), layout);
  return settings;
}

/// An error of `create` skips the case instead of failing it.
template <class Create>
auto or_skip(const Create& create) {
  try {
    return create();
  } catch (const Error& error) {
    throw Error("", fmt::format("{}{}", kSkipped, error.what()));
  }
}

viewer::gpu::Device open_graphics(const viewer::gpu::Instance& instance, bool in_place) {
  viewer::gpu::Device device(instance, {"", {}, in_place});
  if (in_place && !device.imports_memory()) {
    throw Error(device.name(), "it cannot read fields in place");
  }
  return device;
}

constexpr vk::Extent2D kSize{Pictures::kWidth, Pictures::kHeight};

Pictures::Pictures(const Device& solver, const Kind& kind)
    : instance_(or_skip([] { return viewer::gpu::Instance({}, false); })),
      device_(or_skip([&] { return open_graphics(instance_, kind.in_place); })),
      producer_(make_producer(solver, kind.pillars_a_side)),
      settings_(settings_of(*producer_, kind)),
      renderer_(instance_, device_, kSize, 1),
      nothing_(viewer::Target::make_render_pass(device_)),
      target_(device_, *nothing_, kSize) {
  for (std::uint64_t i = 0; i < kFields; ++i) fields_.push_back(producer_->produce(i));
}

void Pictures::draw(int pictures) {
  for (int i = 0; i < pictures; ++i) {
    const viewer::ShownField& field = fields_.at(drawn_++ % fields_.size());
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      renderer_.record(commands, field, producer_->info(), settings_);
    });
  }
}

void Pictures::clear_and_read(int pictures) {
  const std::array<vk::ClearValue, 2> clear{vk::ClearColorValue(std::array{0.1F, 0.2F, 0.3F, 1.0F}),
                                            vk::ClearDepthStencilValue(1, 0)};
  for (int i = 0; i < pictures; ++i) {
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      commands.beginRenderPass({*nothing_, target_.framebuffer(), {{0, 0}, kSize}, clear},
                               vk::SubpassContents::eInline);
      commands.endRenderPass();
    });
    static_cast<void>(viewer::read_pixels(device_, target_.image()));
  }
}

void Pictures::read(int pictures) {
  if (drawn_ == 0) draw(1);
  for (int i = 0; i < pictures; ++i) {
    static_cast<void>(viewer::read_pixels(device_, renderer_.image()));
  }
}

/// 10 x 10 cm and a square metre.
constexpr std::uint32_t kSides[] = {79, kSquareMetre};

struct NamedPicture {
  const char* name;
  bool arrows;
  bool overlay;
  bool in_place;
};
constexpr NamedPicture kPictures[] = {{"heat", false, false, true},
                                      {"arrows", true, false, true},
                                      {"all", true, true, true},
                                      {"all_copied", true, true, false}};

/// Times work on pictures, interleaved with clearing and reading back as many.
Measurement time_pictures(const Session& session, Pictures& pictures, const Work& work) {
  InterleavedTiming timing;
  const std::size_t candidate = timing.add(work);
  const std::size_t clear = timing.add([&](int count) { pictures.clear_and_read(count); });
  timing.run(session.length);
  Measurement measured;
  measured.seconds = timing.median(candidate);
  measured.counters["ms"] = measured.seconds * 1e3;
  // A software renderer draws in threads of this process.
  measured.counters["processor_ms"] = timing.processor_median(candidate) * 1e3;
  measured.counters["ns_per_pixel"] =
      measured.seconds * 1e9 / (double{Pictures::kWidth} * Pictures::kHeight);
  measured.counters["clear_and_read_ms"] = timing.median(clear) * 1e3;
  measured.counters["of_clear_and_read"] = timing.ratio(clear, candidate);
  measured.label = pictures.device_name();
  return measured;
}

Measurement time_drawing(const Session& session, const Pictures::Kind& kind) {
  Pictures pictures(session.device, kind);
  return time_pictures(session, pictures, [&](int count) { pictures.draw(count); });
}

Measurement time_reading(const Session& session) {
  Pictures pictures(session.device, {.pillars_a_side = kSides[0],
                                     .orbit = false,
                                     .arrows = true,
                                     .overlay = true,
                                     .in_place = false});
  return time_pictures(session, pictures, [&](int count) { pictures.read(count); });
}

}  // namespace

void add_render_cases(const Session& session) {
  for (const std::uint32_t side : kSides) {
    for (const bool orbit : {false, true}) {
      for (const NamedPicture& each : kPictures) {
        const Pictures::Kind kind{side, orbit, each.arrows, each.overlay, each.in_place};
        add_case(fmt::format("render/{}/{}/{}", side * side, orbit ? "orbit" : "top", each.name),
                 [&session, kind] { return time_drawing(session, kind); });
      }
    }
  }
  add_case("render/read_back", [&session] { return time_reading(session); });
}

}  // namespace pillarfield::bench
