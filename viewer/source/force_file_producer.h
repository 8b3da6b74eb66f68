#pragma once

#include <filesystem>
#include <optional>

#include "pillarfield/force_file.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/growing_file.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"

namespace pillarfield::viewer {

/// Fields as a file has them, with magnitude and angles computed from the forces.
class ForceFileProducer final : public FieldProducer {
 public:
  /// Of a file that is trusted or that probe_file() has passed. Throws Error where it cannot be
  /// read or has no frames.
  explicit ForceFileProducer(const std::filesystem::path& path);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t index) override;
  [[nodiscard]] ShownContacts contacts_of(const ShownField& field) override;
  bool refresh() override;

 private:
  void open(const std::filesystem::path& path);

  GrowingFile file_;
  std::optional<ForceFileReader> reader_;  ///< none where it could not be opened again
  SourceInfo info_;
  ForceField forces_;  ///< as read last
  ObjectPool<PlaneBlock> blocks_;
  ContactLabels map_;
};

}  // namespace pillarfield::viewer
