#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/session.h"
#include "viewer/render/renderer.h"

namespace pillarfield::bench {

/// The viewer's pictures of a square skin, a tenth of it in contact, without a window. Its frames
/// are solved beforehand.
class Pictures {
 public:
  static constexpr std::uint32_t kWidth = 1280;
  static constexpr std::uint32_t kHeight = 720;

  struct Kind {
    std::uint32_t pillars_a_side;
    bool orbit;     ///< perspective, else from above
    bool arrows;    ///< on the heat map
    bool overlay;   ///< axes and legends
    bool in_place;  ///< reads fields in the solver's memory, else copies them to the device
  };

  /// Throws an Error that begins with kSkipped where no Vulkan device suffices.
  Pictures(const Device& solver, const Kind& kind);

  /// Draws `pictures` pictures of the next fields; waits for each.
  void draw(int pictures);

  /// Clears a target and reads it back, `pictures` times.
  void clear_and_read(int pictures);

  /// Reads the last picture back, `pictures` times.
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
