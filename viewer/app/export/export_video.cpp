#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

#include "pillarfield/child_program.h"
#include "pillarfield/error.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {
namespace {

/// ffmpeg's options for a file name extension.
struct Encoding {
  std::string_view ending;
  const char* codec;
  const char* container;  ///< the muxer, which the temporary name does not determine
};

/// H.264 at a quality that keeps thin lines and small text, with the index first, as players
/// expect; 4:2:0 chroma needs even sizes, and players expect HDTV colours.
constexpr const char* kH264 = "-c:v libx264 -preset medium -crf 16";
constexpr std::array kEncodings{Encoding{".mp4", kH264, "-movflags +faststart -f mp4"},
                                Encoding{".mov", kH264, "-movflags +faststart -f mov"},
                                Encoding{".mkv", kH264, "-f matroska"},
                                Encoding{".webm", "-c:v libvpx-vp9 -crf 24 -b:v 0", "-f webm"}};

const Encoding& encoding_of(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  const auto* const found = std::ranges::find(kEncodings, ending, &Encoding::ending);
  if (found != kEncodings.end()) return *found;
  throw Error(path.string(), "the extension is not a video format",
              "use .mp4, .mkv, .mov or .webm");
}

std::vector<std::string> command(const OutputFile& file, std::uint32_t width, std::uint32_t height,
                                 double rate_hz) {
  const Encoding& encoding = encoding_of(file.path());
  std::istringstream line(
      fmt::format("ffmpeg -hide_banner -loglevel error -nostdin -y -f rawvideo -pixel_format rgb0 "
                  "-video_size {}x{} -framerate {} -i pipe:0 -an "
                  "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709,format=yuv420p "
                  "-colorspace bt709 -color_primaries bt709 -color_trc bt709 {} {}",
                  width, height, rate_hz, encoding.codec, encoding.container));
  std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
  words.push_back("file:" + file.part_path().string());
  return words;
}

void check(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
           double rate_hz) {
  static_cast<void>(encoding_of(path));
  if (width == 0 || height == 0) {
    throw Error(path.string(), "the size is 0 pixels", "set a size above 0");
  }
  if (!std::isfinite(rate_hz) || rate_hz <= 0) {
    throw Error(path.string(), fmt::format("the rate is {} pictures a second", rate_hz),
                "set a rate above 0");
  }
}

}  // namespace

struct VideoWriter::State {
  State(const std::filesystem::path& path, std::uint32_t picture_width,
        std::uint32_t picture_height, double rate_hz, Replace replace)
      : file(path, OutputKind::video, replace),
        ffmpeg(command(file, picture_width, picture_height, rate_hz),
               "install the Debian package ffmpeg, or write a sequence of PNG files"),
        width(picture_width),
        height(picture_height) {}

  [[noreturn]] void fail() const {
    throw Error(file.path().string(), "ffmpeg failed: " + ffmpeg.error_line(),
                "fix that, or write a sequence of PNG files");
  }

  OutputFile file;  ///< declared before ffmpeg, which writes the file
  ChildProgram ffmpeg;
  std::uint32_t width;
  std::uint32_t height;
  std::uint64_t pictures = 0;
  bool finished = false;
};

VideoWriter::VideoWriter(const std::filesystem::path& path, std::uint32_t width,
                         std::uint32_t height, double rate_hz, Replace replace) {
  check(path, width, height, rate_hz);
  state_ = std::make_unique<State>(path, width, height, rate_hz, replace);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Pixels& pixels) {
  const std::filesystem::path& path = state_->file.path();
  if (state_->finished) throw Error(path.string(), "the video is finished", "start another video");
  if (pixels.width != state_->width || pixels.height != state_->height ||
      pixels.rgba.size() != std::size_t{4} * pixels.width * pixels.height) {
    throw Error(path.string(),
                fmt::format("a picture has {} x {} pixels, the video {} x {}", pixels.width,
                            pixels.height, state_->width, state_->height),
                "keep the size while a video is written");
  }
  ++state_->pictures;
  if (state_->ffmpeg.feed(std::as_bytes(std::span(pixels.rgba)))) return;
  state_->finished = true;
  static_cast<void>(state_->ffmpeg.finish());  // Collects its message.
  state_->fail();
}

void VideoWriter::finish() {
  if (state_->finished) return;
  state_->finished = true;
  // On a full disk ffmpeg 5.1 complains, and exits with 0.
  if (!state_->ffmpeg.finish() || !state_->ffmpeg.errors().empty()) state_->fail();
  if (state_->pictures == 0) {
    throw Error(state_->file.path().string(), "the video has no pictures", "add at least one");
  }
  state_->file.commit();
}

}  // namespace pillarfield::viewer
