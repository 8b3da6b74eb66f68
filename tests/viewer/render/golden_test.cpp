// Compares pictures of scenes with reviewed ones in tests/viewer/render/golden. After an intended
// change, PILLARFIELD_DRAW_GOLDEN=1 draws new ones; review each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

#include "tests/viewer/render/drawing.h"
#include "tests/viewer/render/png_file.h"
#include "viewer/app/export/export.h"
#include "viewer/options.h"

namespace pillarfield::viewer {
namespace {

const std::filesystem::path kFolder = PILLARFIELD_GOLDEN_FOLDER;
constexpr std::uint32_t kWidth = 640;
constexpr std::uint32_t kHeight = 400;

struct GoldenPicture {
  const char* name;
  const char* scene;
  std::uint64_t frame;
  Options options;
};

/// GoogleTest's hook for printing a parameter.
// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const GoldenPicture& picture, std::ostream* stream) { *stream << picture.name; }

Options look_at(Quantity quantity) {
  Options options;
  options.quantity = quantity;
  return options;
}

Options with(Options options, void (*change)(Options&)) {
  change(options);
  return options;
}

const std::vector<GoldenPicture>& golden_pictures() {
  static const std::vector<GoldenPicture> pictures{
      {"demo_normal", "demo", 30, look_at(Quantity::normal)},
      {"demo_region_light", "demo", 30,
       with(look_at(Quantity::region), [](Options& o) { o.theme = Theme::light; })},
      {"demo_status", "demo", 10, look_at(Quantity::status)},
      {"demo_orbit", "demo", 50,
       with(look_at(Quantity::magnitude), [](Options& o) { o.orbit = true; })},
      {"demo_relief", "demo", 50,
       with(look_at(Quantity::normal),
            [](Options& o) {
              o.orbit = true;
              o.relief = true;
            })},
      {"demo_uncertainty_zoom", "demo", 30,
       with(look_at(Quantity::uncertainty),
            [](Options& o) {
              o.zoom = 5;
              o.sectors = true;
              o.centre_mm = Vec2{6, 1};
            })},
      {"demo_contacts", "demo", 30,
       with(look_at(Quantity::normal),
            [](Options& o) {
              o.contacts = true;
              o.arrows = false;
            })},
      {"sliding_shear_x", "sliding", 20, look_at(Quantity::shear_x)},
      {"sliding_cylinder", "sliding", 25,
       with(look_at(Quantity::shear),
            [](Options& o) {
              o.orbit = true;
              o.azimuth = -0.8;
              o.elevation = 0.5;
              o.surface = Surface{SurfaceKind::cylinder, 25};
            })},
      {"spin_phi", "spin", 0, look_at(Quantity::phi)},
      {"spin_theta_light", "spin", 0,
       with(look_at(Quantity::theta), [](Options& o) { o.theme = Theme::light; })},
      {"spin_parity_large_letters", "spin", 0,
       with(look_at(Quantity::parity),
            [](Options& o) {
              o.scale = 1.5;
              o.arrows = false;
            })},
  };
  return pictures;
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

/// The picture moved by a pixel to the right.
Pixels shifted(const Pixels& pixels) {
  Pixels moved = pixels;
  for (std::size_t y = 0; y < pixels.height; ++y) {
    for (std::size_t x = 1; x < pixels.width; ++x) {
      for (std::size_t channel = 0; channel < 4; ++channel) {
        moved.rgba[4 * (y * pixels.width + x) + channel] =
            pixels.rgba[4 * (y * pixels.width + x - 1) + channel];
      }
    }
  }
  return moved;
}

class Golden : public testing::TestWithParam<GoldenPicture> {
 protected:
  static Pixels draw(const GoldenPicture& picture, const std::optional<ColourMap>& other_map = {}) {
    const auto producer = open_producer(
        std::filesystem::path(PILLARFIELD_SCENES) / (std::string(picture.scene) + ".toml"), {});
    const double scale = picture.options.scale > 0 ? picture.options.scale : 1;
    RenderSettings settings = default_settings(picture.options, *producer, scale);
    settings.view =
        first_view(picture.options, producer->info(), layout_of(kWidth, kHeight, settings));
    if (other_map) settings.map = *other_map;
    Drawing drawing;
    ShownField field = producer->produce(picture.frame);
    if (settings.contacts) {
      field.contacts = std::make_shared<const ShownContacts>(producer->contacts_of(field));
    }
    Pixels pixels = drawing.draw(field, producer->info(), settings, kWidth, kHeight);
    EXPECT_EQ(drawing.validation_messages(), 0);
    return pixels;
  }
};

TEST_P(Golden, EqualsTheReviewedPicture) {
  const GoldenPicture& picture = GetParam();
  const std::filesystem::path file = kFolder / (std::string(picture.name) + ".png");
  const Pixels drawn = draw(picture);
  if (std::getenv("PILLARFIELD_DRAW_GOLDEN") != nullptr) write_png(file, drawn);
  const Pixels golden = read_png(file);
  const double share = fraction_differing(drawn, golden);
  if (share > kTolerance) {
    write_png(std::string(picture.name) + "_drawn.png", drawn);
    FAIL() << share << " of the pixels differ; the picture is in " << picture.name << "_drawn.png";
  }
}

TEST_P(Golden, WouldShowAShiftOfOnePixel) {
  const Pixels golden = read_png(kFolder / (std::string(GetParam().name) + ".png"));
  EXPECT_GT(fraction_differing(shifted(golden), golden), 5 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_pictures()),
                         [](const auto& test) { return std::string(test.param.name); });

class GoldenColours : public Golden {};

TEST_P(GoldenColours, WouldShowAnotherColourMap) {
  const Pixels golden = read_png(kFolder / (std::string(GetParam().name) + ".png"));
  const bool is_cividis =
      default_map(info_of(GetParam().options.quantity).scale) == ColourMap::cividis;
  const Pixels other = draw(GetParam(), is_cividis ? ColourMap::viridis : ColourMap::cividis);
  EXPECT_GT(fraction_differing(other, golden), 5 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Pictures, GoldenColours,
                         testing::Values(golden_pictures().front(), golden_pictures().at(6),
                                         golden_pictures().at(8)),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pillarfield::viewer
