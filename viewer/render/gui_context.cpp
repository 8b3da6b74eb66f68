#include "viewer/render/gui_context.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kFontBeside = "../share/pillarfield/DejaVuSans.ttf";  ///< the program
constexpr float kFontSize = 14;

void check_result(VkResult result) {
  if (result == VK_SUCCESS) return;
  throw Error("Vulkan", vk::to_string(static_cast<vk::Result>(result)),
              "start the viewer again; if the error persists, choose another device with --gpu");
}

vk::raii::DescriptorPool make_texture_pool(const gpu::Device& device) {
  const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 4);
  return {device.handle(), vk::DescriptorPoolCreateInfo(
                               vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 4, size)};
}

/// Glyph ranges beyond Latin: Greek, minus, dashes, arrows, superscripts.
constexpr std::array<ImWchar, 13> kGlyphs{0x0020, 0x00ff, 0x0391, 0x03c9, 0x2010, 0x2027, 0x2030,
                                          0x205e, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};

/// Glyphs that the font of ImGui, Latin-1, lacks, each with one in its place without DejaVu Sans.
constexpr std::array<ImWchar, 18> kSubstitutes{0x2212, '-', 0x2013, '-', 0x2026, '.',
                                               0x2190, '<', 0x2191, '^', 0x2192, '>',
                                               0x2193, 'v', 0x03b8, 'O', 0x03c6, 0xf8};

void load_font(ImGuiIO& io, double scale) {
  const float size = kFontSize * static_cast<float>(scale);
  std::error_code unknown;
  std::string font =
      std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path() / kFontBeside;
  if (!std::filesystem::exists(font)) font = kFont;
  if (std::filesystem::exists(font)) {
    io.Fonts->AddFontFromFileTTF(font.c_str(), size, nullptr, kGlyphs.data());
  } else {
    ImFontConfig config;
    config.SizePixels = size;
    io.Fonts->AddFontDefault(&config);
  }
}

}  // namespace

GuiContext::GuiContext(const gpu::Instance& instance, const gpu::Device& device,
                       vk::RenderPass render_pass, double scale)
    : scale_(scale), context_(ImGui::CreateContext()), pool_(make_texture_pool(device)) {
  use();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // No settings file.
  io.LogFilename = nullptr;
  load_font(io, scale);

  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = *instance.handle();
  info.PhysicalDevice = *device.physical();
  info.Device = *device.handle();
  info.QueueFamily = device.queue_family();
  info.Queue = *device.queue();
  info.DescriptorPool = *pool_;
  info.MinImageCount = 2;
  info.ImageCount = 2;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check_result;
  ImGui_ImplVulkan_Init(&info, render_pass);
#if IMGUI_VERSION_NUM < 19000
  device.run([](const vk::raii::CommandBuffer& commands) {
    ImGui_ImplVulkan_CreateFontsTexture(*commands);
  });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
#else
  ImGui_ImplVulkan_CreateFontsTexture();
#endif
  ImFont& font = *io.Fonts->Fonts.front();
  for (std::size_t i = 0; i < kSubstitutes.size(); i += 2) {
    if (font.FindGlyphNoFallback(kSubstitutes[i]) != nullptr) continue;
    font.AddRemapChar(kSubstitutes[i], kSubstitutes[i + 1]);
  }
}

GuiContext::~GuiContext() {
  use();
  ImGui_ImplVulkan_Shutdown();
  ImGui::DestroyContext(context_);
}

void GuiContext::use() const { ImGui::SetCurrentContext(context_); }

void GuiContext::draw(const vk::raii::CommandBuffer& commands) const {
  use();
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
}

}  // namespace pillarfield::viewer
