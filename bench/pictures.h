#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/session.h"
#include "viewer/render/renderer.h"

namespace pillarfield::bench {

/// Pictures of the viewer's own drawing, without a window: of a square skin with a tenth of it in
/// contact, whose frames were solved beforehand.
class Pictures {
 public:
  static constexpr std::uint32_t kWidth = 1280;
  static constexpr std::uint32_t kHeight = 720;

  struct Kind {
    std::uint32_t pillars_a_side;
    bool orbit;     ///< in perspective, else from above
    bool arrows;    ///< upon the heat map
    bool overlay;   ///< axes and legends around it
    bool in_place;  ///< fields are read where the solver left them, else copied to the device
  };

  /// Throws Error that begins with kSkipped where no device of Vulkan will do.
  Pictures(const Device& solver, const Kind& kind);

  /// Draws so many pictures, each of the next of a few fields; waits for each.
  void draw(int pictures);

  /// The same of pictures of nothing, each of which is read back.
  void clear_and_read(int pictures);

  /// Reads the last picture so many times.
  void read(int pictures);

  [[nodiscard]] const std::string& device_name() const { return device_.name(); }

 private:
  viewer::gpu::Instance instance_;
  viewer::gpu::Device device_;
  std::unique_ptr<viewer::FieldProducer> producer_;
  std::vector<viewer::ShownField> fields_;
  viewer::RenderSettings settings_;
  viewer::Renderer renderer_;
  vk::raii::RenderPass nothing_;
  viewer::Target target_;
  std::size_t drawn_ = 0;
};

}  // namespace pillarfield::bench
