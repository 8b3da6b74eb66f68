// Compares pictures of scenes with reviewed ones in tests/viewer/render/golden. After an intended
// change, PILLARFIELD_DRAW_GOLDEN=1 draws new ones; review each.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

#include "pillarfield/calibration.h"
#include "pillarfield/error.h"
#include "viewer/app/export/export.h"
#include "viewer/options.h"
#include "viewer/render/renderer.h"

namespace pillarfield::viewer {
namespace {

const std::filesystem::path kFolder = PILLARFIELD_GOLDEN_FOLDER;
constexpr std::uint32_t kWidth = 640;
constexpr std::uint32_t kHeight = 400;

/// A graphics device with the validation layer where installed. Prefers a software device, whose
/// pictures do not depend on the computer.
class Drawing {
 public:
  explicit Drawing(bool import_memory = true)
      : instance_(watched_instance()),
        device_(preferred_device(instance_, import_memory)),
        renderer_(instance_, device_, {kWidth, kHeight}, 1) {}

  [[nodiscard]] Pixels draw(const ShownField& field, const SourceInfo& source,
                            const RenderSettings& settings) {
    renderer_.resize({kWidth, kHeight}, settings.scale);
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      renderer_.record(commands, field, source, settings);
    });
    EXPECT_EQ(instance_.validation_messages(), 0);
    return read_pixels(device_, renderer_.image());
  }
  [[nodiscard]] bool imports_memory() const { return device_.imports_memory(); }
  [[nodiscard]] FieldMemory& memory() { return renderer_.memory(); }

 private:
  static gpu::Instance watched_instance() {
    try {
      return {{}, true};
    } catch (const Error&) {
      return {{}, false};
    }
  }
  static gpu::Device preferred_device(const gpu::Instance& instance, bool import_memory) {
    try {
      return {instance, {"llvmpipe", {}, import_memory}};
    } catch (const Error&) {
      return {instance, {"", {}, import_memory}};
    }
  }

  gpu::Instance instance_;
  gpu::Device device_;
  Renderer renderer_;
};

Pixels read_png(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << path;
  image.format = PNG_FORMAT_RGBA;
  Pixels pixels{image.width, image.height, {}};
  pixels.rgba.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr), 0) << path;
  return pixels;
}

/// A picture by the words of the command line, the scene without its folder.
struct GoldenPicture {
  const char* name;
  std::vector<std::string> words;
};

/// GoogleTest's hook for printing a parameter.
// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const GoldenPicture& picture, std::ostream* stream) { *stream << picture.name; }

const std::vector<GoldenPicture>& golden_pictures() {
  static const std::vector<GoldenPicture> pictures{
      {"demo_normal", {"demo.toml", "--frame=31"}},
      {"demo_region_light", {"demo.toml", "--frame=31", "--layer=region", "--light"}},
      {"demo_status", {"demo.toml", "--frame=11", "--layer=status"}},
      {"demo_orbit", {"demo.toml", "--frame=51", "--layer=magnitude", "--view=orbit"}},
      {"demo_relief", {"demo.toml", "--frame=51", "--view=orbit", "--relief"}},
      {"demo_uncertainty_zoom",
       {"demo.toml", "--frame=31", "--layer=uncertainty", "--zoom=5", "--centre=6,1", "--sectors"}},
      {"demo_contacts", {"demo.toml", "--frame=31", "--contacts", "--no-arrows"}},
      {"pad_values", {"touch/pad.toml", "--frame=71", "--layer=pressure", "--zoom=8"}},
      {"pad_half", {"touch/pad.toml", "--frame=71", "--layer=pressure"}},
      {"pad_pressure", {"touch/pad.toml", "--frame=71", "--layer=pressure", "--contacts"}},
      {"sliding_shear_x", {"touch/sliding.toml", "--frame=21", "--layer=shear_x"}},
      {"sliding_cylinder",
       {"touch/sliding.toml", "--frame=26", "--layer=shear",
        "--view=orbit:-45.83662361,28.64788976", "--surface=cylinder:25"}},
      {"spin_phi", {"touch/spin.toml", "--layer=phi"}},
      {"spin_theta_light", {"touch/spin.toml", "--layer=theta", "--light"}},
      {"spin_parity_large_letters",
       {"touch/spin.toml", "--layer=parity", "--scale=1.5", "--no-arrows"}},
  };
  return pictures;
}

Options options_of(const GoldenPicture& picture) {
  std::vector<std::string> words = picture.words;
  words[0] = std::string(PILLARFIELD_SCENES) + "/" + words[0];
  words.insert(words.begin(), "pillarfield-viewer");
  if (std::ranges::find(words, "--contacts") == words.end()) words.push_back("--no-contacts");
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (std::string& word : words) arguments.push_back(word.data());
  Options options;
  EXPECT_FALSE(parse_options(static_cast<int>(arguments.size()), arguments.data(), options));
  return options;
}

/// Fraction of pixels that differ by more than rounding.
double fraction_differing(const Pixels& a, const Pixels& b) {
  if (a.width != b.width || a.height != b.height) return 1;
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      most = std::max(most, std::abs(int{a.rgba[i + channel]} - int{b.rgba[i + channel]}));
    }
    if (most > 12) ++others;
  }
  return static_cast<double>(others) / (static_cast<double>(a.rgba.size()) / 4);
}

// Pixels at borders of pillars and arrows may round differently on another processor.
constexpr double kTolerance = 0.0008;

/// A field of a scene with the settings of its picture.
struct Scenery {
  explicit Scenery(const GoldenPicture& picture)
      : options(options_of(picture)),
        producer(open_producer(options.source, {})),
        settings(default_settings(options, *producer, options.scale > 0 ? options.scale : 1)),
        field(producer->produce(options.first_frame)),
        source(producer->info()) {
    settings.view = first_view(options, source, layout_of(kWidth, kHeight, settings));
    if (!settings.contacts) return;
    field.contacts = std::make_shared<const ShownContacts>(producer->contacts_of(field));
  }

  Options options;
  std::unique_ptr<FieldProducer> producer;
  RenderSettings settings;
  ShownField field;
  SourceInfo source;
};

/// The right half of the pad has no sensel.
void take_half_away(SourceInfo& source) {
  source.calibration.mask.assign(source.skin.sensels(), 0);
  for (std::size_t i = 0; i < source.skin.sensels(); ++i) {
    if (i % source.skin.cols >= source.skin.cols / 2) source.calibration.mask[i] = kAbsent;
  }
}

class Golden : public testing::TestWithParam<GoldenPicture> {};

TEST_P(Golden, EqualsTheReviewedPicture) {
  const GoldenPicture& picture = GetParam();
  const std::filesystem::path file = kFolder / (std::string(picture.name) + ".png");
  Scenery scenery(picture);
  if (std::string_view(picture.name) == "pad_half") take_half_away(scenery.source);
  const Pixels drawn = Drawing().draw(scenery.field, scenery.source, scenery.settings);
  if (std::getenv("PILLARFIELD_DRAW_GOLDEN") != nullptr) write_png(file, drawn);
  const Pixels golden = read_png(file);
  const double share = fraction_differing(drawn, golden);
  if (share > kTolerance) {
    write_png(std::string(picture.name) + "_drawn.png", drawn);
    FAIL() << share << " of the pixels differ; the picture is in " << picture.name << "_drawn.png";
  }
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_pictures()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GoldenPictures, WouldShowAnotherColourMap) {
  const GoldenPicture& picture = golden_pictures().front();
  Scenery scenery(picture);
  scenery.settings.map = ColourMap::viridis;
  const Pixels other = Drawing().draw(scenery.field, scenery.source, scenery.settings);
  const Pixels golden = read_png(kFolder / (std::string(picture.name) + ".png"));
  EXPECT_GT(fraction_differing(other, golden), 5 * kTolerance);
}

TEST(GoldenPictures, AreTheSameOfMemoryReadInPlaceAndCopied) {
  const Scenery scenery(golden_pictures().front());
  Drawing in_place;
  Drawing copied(false);
  EXPECT_EQ(in_place.draw(scenery.field, scenery.source, scenery.settings).rgba,
            copied.draw(scenery.field, scenery.source, scenery.settings).rgba);
  EXPECT_EQ(copied.memory().bytes_copied(), scenery.field.pages.size());
  if (!in_place.imports_memory()) GTEST_SKIP() << "this device reads no host memory";
  EXPECT_EQ(in_place.memory().bytes_copied(), 0U);
}

}  // namespace
}  // namespace pillarfield::viewer
