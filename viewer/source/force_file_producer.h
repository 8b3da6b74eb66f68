#pragma once

#include <filesystem>
#include <optional>

#include "pillarfield/force_file.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/growing_file.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"

namespace pillarfield::viewer {

/// Reads fields from a file; computes magnitude and angles from the forces.
class ForceFileProducer final : public FieldProducer {
 public:
  /// Throws Error where the file cannot be read or has no frames.
  ForceFileProducer(const std::filesystem::path& path, ReadOptions options);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;
  [[nodiscard]] ShownContacts contacts_of(const ShownField& field) override;
  bool refresh() override;
  [[nodiscard]] std::optional<CurvePoint> stored_total(std::uint64_t index) override;

 private:
  void open(const std::filesystem::path& path);

  GrowingFile file_;
  ReadOptions read_;
  std::optional<ForceFileReader> reader_;  ///< none where reopening failed
  SourceInfo info_;
  ForceField forces_;  ///< read last
  ObjectPool<PlaneBlock> blocks_;
  ContactLabels map_;
};

}  // namespace pillarfield::viewer
