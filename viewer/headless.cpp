#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"
#include "viewer/app/app.h"
#include "viewer/app/export/export.h"
#include "viewer/app/field_place.h"
#include "viewer/app/source/loaded_source.h"
#include "viewer/render/renderer.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

/// Draws pictures and reads their pixels back.
class HeadlessRenderer {
 public:
  explicit HeadlessRenderer(const Options& options)
      : instance_({}, options.validate),
        device_(instance_, {options.gpu, {}, !options.copy_fields}),
        renderer_(instance_, device_, {options.width, options.height}, scale_of(options)) {}

  [[nodiscard]] static double scale_of(const Options& options) {
    return options.scale > 0 ? options.scale : 1;
  }

  [[nodiscard]] Pixels render(const ShownField& field, const SourceInfo& source,
                              const RenderSettings& settings) {
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      renderer_.record(commands, field, source, settings);
    });
    return read_pixels(device_, renderer_.image());
  }

  [[nodiscard]] int validation_messages() const { return instance_.validation_messages(); }

 private:
  gpu::Instance instance_;
  gpu::Device device_;
  Renderer renderer_;
};

struct FrameRange {
  std::uint64_t begin;
  std::uint64_t end;
};

FrameRange frames_of(const Options& options, FieldProducer& producer) {
  const SourceInfo& source = producer.info();
  const std::uint64_t first = options.has_frame ? options.first_frame : most_loaded_frame(producer);
  const FrameRange span{first, options.end_frame != 0 ? options.end_frame : first + 1};
  if (span.end <= source.frames) return span;
  throw Error(source.name, fmt::format("it has no frame {}", span.end),
              fmt::format("its frames are 1 to {}", source.frames));
}

bool asks_for_sequence(const Options& options) {
  return options.end_frame > options.first_frame + 1;
}

/// File names of the pictures: one, or one for each frame.
std::vector<std::filesystem::path> png_names(const Options& options, const FrameRange& span,
                                             std::uint64_t frames) {
  if (options.png.empty()) return {};
  if (!asks_for_sequence(options)) return {options.png};
  std::vector<std::filesystem::path> names;
  for (std::uint64_t frame = span.begin; frame < span.end; ++frame) {
    names.push_back(numbered(options.png, frame + 1, frames));
  }
  return names;
}

Replace replace_of(const Options& options) {
  return options.overwrite ? Replace::anything : Replace::results;
}

void make_folder_of(const std::filesystem::path& path) {
  if (!path.has_parent_path()) return;
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) throw Error(path.parent_path().string(), error.message(), "choose another folder");
}

void check_exports(const Options& options, const std::vector<std::filesystem::path>& pictures,
                   Replace replace) {
  std::vector<PlannedOutput> outputs;
  outputs.reserve(pictures.size() + 2);
  for (const auto& picture : pictures) outputs.push_back({picture, OutputKind::png});
  if (!options.csv.empty()) outputs.push_back({options.csv, OutputKind::forces});
  if (!options.video.empty()) outputs.push_back({options.video, OutputKind::video});
  for (const PlannedOutput& output : outputs) make_folder_of(output.path);
  check_outputs({options.source}, outputs, replace);
  if (options.csv.empty() || options.csv.extension() == ".csv") return;
  throw Error(options.csv.string(), "a table must end in .csv", "rename it");
}

/// Pictures a second of a video, and how many each frame of the source has in it, which `speed` and
/// `fps` determine: the picture k shows the frame floor(k step).
class VideoPace {
 public:
  VideoPace(const Options& options, double rate_hz)
      : fps_(options.fps.value_or(std::clamp(rate_hz * options.speed, 1.0, kMostFps))),
        step_(rate_hz * options.speed / fps_) {}

  [[nodiscard]] double fps() const { return fps_; }

  /// `index` counts from the first frame of the video.
  [[nodiscard]] std::uint64_t pictures_of(std::uint64_t index) const {
    return pictures_before(index + 1) - pictures_before(index);
  }

  [[nodiscard]] std::uint64_t pictures_before(std::uint64_t index) const {
    constexpr double kTolerance = 1e-9;
    return static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(index) / step_ * (1 - kTolerance)));
  }

 private:
  static constexpr double kMostFps = 60;

  double fps_;
  double step_;  ///< frames of the source from a picture to the next
};

/// "0.6 s long; --speed 0.1 makes it slower".
std::string length_words(const Options& options, const FrameRange& span, double rate_hz) {
  constexpr double kShortS = 3;
  const VideoPace pace(options, rate_hz);
  const auto pictures = static_cast<double>(pace.pictures_before(span.end - span.begin));
  const double length_s = pictures / pace.fps();
  return fmt::format(
      "{:.3g} s long{}", length_s,
      length_s < kShortS && options.speed >= 1 ? "; --speed 0.1 makes it slower" : "");
}

void tell_written(const Options& options, const std::vector<std::filesystem::path>& pictures,
                  const FrameRange& span, const SourceInfo& source) {
  const auto tell = [](const std::string& words) { fmt::print("Wrote {}\n", printable(words)); };
  const std::string which = options.has_frame ? ""
                                              : fmt::format(": frame {} of {}, the most loaded",
                                                            span.begin + 1, source.frames);
  if (!options.csv.empty()) tell(options.csv.string() + which);
  if (pictures.size() == 1) tell(pictures.front().string() + which);
  if (pictures.size() > 1) {
    tell(fmt::format("{} to {}", pictures.front().string(), pictures.back().filename().string()));
  }
  if (options.video.empty()) return;
  tell(options.video.string() + ": " + length_words(options, span, source.rate_hz));
}

/// Complete pictures stay; an incomplete video is removed.
void stop_if_interrupted(const Options& options, std::uint64_t pictures) {
  if (!is_interrupted()) return;
  throw Error(options.source.string(), fmt::format("interrupted after {} pictures", pictures),
              "start again");
}

std::unique_ptr<FieldProducer> open_headless(const Options& options) {
  const bool on_terminal = isatty(STDERR_FILENO) == 1;
  return open_producer(options.source, producer_options(options, [=](const std::string& line) {
                         if (on_terminal) fmt::print(stderr, "{}\n", printable(line));
                       }));
}

Pixels draw(HeadlessRenderer& headless, FieldProducer& producer, std::uint64_t frame,
            const RenderSettings& settings) {
  ShownField field = producer.produce(frame);
  if (settings.contacts) {
    field.contacts = std::make_shared<const ShownContacts>(producer.contacts_of(field));
  }
  return headless.render(field, producer.info(), settings);
}

/// Renders the frames of `span` into `pictures` and the video.
void write_pictures(const Options& options, FieldProducer& producer, const RenderSettings& settings,
                    const FrameRange& span, const std::vector<std::filesystem::path>& pictures) {
  HeadlessRenderer headless(options);
  const VideoPace pace(options, producer.info().rate_hz);
  std::unique_ptr<VideoWriter> video;
  if (!options.video.empty()) {
    video = std::make_unique<VideoWriter>(options.video, options.width, options.height, pace.fps(),
                                          replace_of(options));
  }
  for (std::uint64_t frame = span.begin; frame < span.end; ++frame) {
    stop_if_interrupted(options, frame - span.begin);
    const Pixels pixels = draw(headless, producer, frame, settings);
    if (!pictures.empty()) write_png(pictures[frame - span.begin], pixels, replace_of(options));
    if (video == nullptr) continue;
    const std::uint64_t repeats = pace.pictures_of(frame - span.begin);
    for (std::uint64_t i = 0; i < repeats; ++i) video->add(pixels);
  }
  if (video != nullptr) video->finish();
  if (headless.validation_messages() != 0) {
    throw Error("Vulkan", fmt::format("validation had {} messages", headless.validation_messages()),
                "please report them");
  }
}

}  // namespace

void run_headless(const Options& options) {
  const Replace replace = replace_of(options);
  // Check the options before opening the source, which may take long.
  const bool names_are_known = !options.png.empty() && !asks_for_sequence(options);
  using Paths = std::vector<std::filesystem::path>;
  check_exports(options, names_are_known ? Paths{options.png} : Paths{}, replace);
  const std::unique_ptr<FieldProducer> producer = open_headless(options);
  const SourceInfo& source = producer->info();
  fmt::print(stderr, "{}", warning_lines(source));
  const FrameRange span = frames_of(options, *producer);
  const Paths pictures = png_names(options, span, source.frames);
  check_exports(options, pictures, replace);
  RenderSettings settings =
      default_settings(options, *producer, HeadlessRenderer::scale_of(options));
  const Viewport picture{0, 0, static_cast<double>(options.width),
                         static_cast<double>(options.height)};
  settings.view = first_view(options, source, layout_of(picture.width, picture.height, settings));

  if (!options.csv.empty()) {
    write_csv(options.csv, producer->produce(span.begin),
              visible_pillars({picture, &source}, settings), replace);
  }
  if (options.png.empty() && options.video.empty()) {
    tell_written(options, pictures, span, source);
    return;
  }
  write_pictures(options, *producer, settings, span, pictures);
  tell_written(options, pictures, span, source);
}

}  // namespace pillarfield::viewer
