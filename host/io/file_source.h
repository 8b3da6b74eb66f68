#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pillarfield/recording.h"

namespace pillarfield {

/// The part of FrameSource that all file formats share.
class FileSource : public FrameSource {
 public:
  [[nodiscard]] const std::string& format() const override { return format_; }
  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return type_; }
  [[nodiscard]] std::uint64_t frames() const override { return frames_; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] bool has_truth() const override { return false; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }
  void read_truth(std::uint64_t index, ForceField& truth) override;

 protected:
  FileSource(std::filesystem::path path, std::string format);

  void require_frame(std::uint64_t index) const;
  void require_fitting(const FrameBuffer& frame) const;

  /// Warns of an odd last row or column, which has no pillars, and of a file without frames.
  void warn_of_size();

  std::filesystem::path path_;
  std::string format_;
  Skin skin_;
  SenselType type_ = SenselType::u8;
  std::uint64_t frames_ = 0;
  Calibration calibration_;
  std::vector<std::string> warnings_;
};

}  // namespace pillarfield
