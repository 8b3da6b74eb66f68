#include <utility>

#include "pillarfield/error.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/frame_provider.h"
#include "viewer/source/growing_file.h"
#include "viewer/source/object_pool.h"

namespace pillarfield::viewer {
namespace {

class RecordedFrames final : public FrameProvider {
 public:
  RecordedFrames(const std::filesystem::path& path, std::unique_ptr<FrameSource> source,
                 ReadOptions options)
      : file_(path),
        options_(std::move(options)),
        source_(std::move(source)),
        skin_(source_->skin()),
        sensel_type_(source_->sensel_type()),
        frames_(source_->frames()),
        buffers_(FieldProducer::kMostShown, [this] {
          return std::make_unique<FrameBuffer>(sensel_type_, skin_.rows, skin_.cols);
        }) {
    options_.trust = true;     // probed before
    options_.tare_frames = 0;  // The tare stays that of the first opening.
  }

  [[nodiscard]] std::uint64_t frames() const override { return frames_; }

  [[nodiscard]] FrameHandle frame(std::uint64_t index) override {
    if (source_ == nullptr) open(file_.path());
    const std::shared_ptr<FrameBuffer> buffer = buffers_.acquire();
    if (buffer == nullptr) throw_all_fields_in_use();
    const double time_s = source_->read(index, *buffer);
    return {buffer, time_s};
  }

  bool refresh() override {
    if (!file_.may_have_changed()) return false;
    source_.reset();  // HDF5 does not show new data in a file that it holds open.
    if (!file_.reopen([this](const std::filesystem::path& path) { open(path); })) return false;
    const std::uint64_t before = std::exchange(frames_, source_->frames());
    return frames_ != before;
  }

 private:
  void open(const std::filesystem::path& path) {
    std::unique_ptr<FrameSource> source = open_frames(path, options_);
    const Skin& skin = source->skin();
    if (skin.rows != skin_.rows || skin.cols != skin_.cols ||
        source->sensel_type() != sensel_type_ || source->frames() == 0) {
      throw Error(path.string(), "it was replaced by another recording", "open it again");
    }
    source_ = std::move(source);
  }

  GrowingFile file_;
  ReadOptions options_;
  std::unique_ptr<FrameSource> source_;  ///< null where reopening failed
  Skin skin_;
  SenselType sensel_type_;
  std::uint64_t frames_;
  ObjectPool<FrameBuffer> buffers_;
};

}  // namespace

std::unique_ptr<FrameProvider> recorded_frames(const std::filesystem::path& path,
                                               std::unique_ptr<FrameSource> source,
                                               ReadOptions options) {
  return std::make_unique<RecordedFrames>(path, std::move(source), std::move(options));
}

}  // namespace pillarfield::viewer
