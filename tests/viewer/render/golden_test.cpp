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

class Golden : public testing::TestWithParam<GoldenPicture> {
 protected:
  static Pixels draw(const GoldenPicture& picture, const std::optional<ColourMap>& other_map = {}) {
    const Options options = options_of(picture);
    const auto producer = open_producer(options.source, {});
    RenderSettings settings =
        default_settings(options, *producer, options.scale > 0 ? options.scale : 1);
    settings.view = first_view(options, producer->info(), layout_of(kWidth, kHeight, settings));
    if (other_map) settings.map = *other_map;
    Drawing drawing;
    ShownField field = producer->produce(options.first_frame);
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

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_pictures()),
                         [](const auto& test) { return std::string(test.param.name); });

class GoldenColours : public Golden {};

TEST_P(GoldenColours, WouldShowAnotherColourMap) {
  const Pixels golden = read_png(kFolder / (std::string(GetParam().name) + ".png"));
  const bool is_cividis =
      default_map(info_of(options_of(GetParam()).look.quantity).scale) == ColourMap::cividis;
  const Pixels other = draw(GetParam(), is_cividis ? ColourMap::viridis : ColourMap::cividis);
  EXPECT_GT(fraction_differing(other, golden), 5 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Pictures, GoldenColours,
                         testing::Values(golden_pictures().front(), golden_pictures().at(6),
                                         golden_pictures().at(9)),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace pillarfield::viewer
