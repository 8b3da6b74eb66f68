#include "viewer/headless.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "pillarfield/error.h"
#include "viewer/app/export.h"
#include "viewer/app/field_place.h"
#include "viewer/draw/painter.h"
#include "viewer/draw/scene.h"

namespace pillarfield::viewer {
namespace {

/// Draws pictures one after the other and reads each back.
class Renderer {
 public:
  explicit Renderer(const Options& options)
      : instance_({}, options.validate),
        device_(instance_, {options.gpu, {}, !options.copy_fields}),
        painter_(instance_, device_, {options.width, options.height}, scale_of(options)) {}

  [[nodiscard]] static double scale_of(const Options& options) {
    return options.scale > 0 ? options.scale : 1;
  }

  [[nodiscard]] Pixels render(const ShownField& field, const SourceInfo& source, const Look& look) {
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      painter_.record(commands, field, source, look);
    });
    return read_pixels(device_, painter_.image());
  }

  [[nodiscard]] int validation_messages() const { return instance_.validation_messages(); }

 private:
  gpu::Instance instance_;
  gpu::Device device_;
  Painter painter_;
};

struct Span {
  std::uint64_t begin;
  std::uint64_t end;
};

Span frames_of(const Options& options, const SourceInfo& source) {
  const Span span{options.first_frame,
                  options.end_frame != 0 ? options.end_frame : options.first_frame + 1};
  if (span.end <= source.frames) return span;
  throw Error(source.name, fmt::format("it has no frame {}", span.end),
              fmt::format("its frames are 1 to {}", source.frames));
}

}  // namespace

void run_headless(const Options& options) {
  const auto producer = open_producer(
      options.source, {.device = options.device, .read = {.trust = options.trust_input}});
  const SourceInfo& source = producer->info();
  for (const std::string& remark : source.remarks) {
    fmt::print(stderr, "pillarfield-viewer: {}: {}\n", source.name, remark);
  }
  const Span span = frames_of(options, source);
  Look look = first_look(options, *producer, Renderer::scale_of(options));
  const Viewport plot = layout_of(options.width, options.height, look).plot;
  look.view = first_view(options, source, plot);

  if (!options.csv.empty()) {
    const Viewport picture{0, 0, static_cast<double>(options.width),
                           static_cast<double>(options.height)};
    write_csv(options.csv, producer->produce(span.begin),
              visible_pillars({picture, &source}, look));
  }
  if (options.png.empty() && options.video.empty()) return;
  Renderer renderer(options);
  std::unique_ptr<VideoWriter> video;
  if (!options.video.empty()) {
    video =
        std::make_unique<VideoWriter>(options.video, options.width, options.height, source.rate_hz);
  }
  for (std::uint64_t frame = span.begin; frame < span.end; ++frame) {
    ShownField field = producer->produce(frame);
    if (look.contacts) {
      field.contacts = std::make_shared<const ShownContacts>(producer->contacts_of(field));
    }
    const Pixels pixels = renderer.render(field, source, look);
    if (!options.png.empty()) {
      write_png(span.end - span.begin == 1 ? options.png
                                           : numbered(options.png, frame + 1, source.frames),
                pixels);
    }
    if (video != nullptr) video->add(pixels);
  }
  if (video != nullptr) video->finish();
  if (renderer.validation_messages() != 0) {
    throw Error("Vulkan", fmt::format("validation had {} messages", renderer.validation_messages()),
                "please report them");
  }
}

}  // namespace pillarfield::viewer
