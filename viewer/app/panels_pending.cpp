// Stands in for panels and exports until they are there; goes then.
#include <imgui.h>

#include "pillarfield/error.h"
#include "viewer/app/export.h"
#include "viewer/app/panels.h"

namespace pillarfield::viewer {

[[gnu::weak]] void hover_panel(const Session& /*session*/) { ImGui::TextDisabled("–"); }
[[gnu::weak]] void pillar_panel(Session& /*session*/) { ImGui::TextDisabled("–"); }
[[gnu::weak]] void region_panel(Session& /*session*/) { ImGui::TextDisabled("–"); }
[[gnu::weak]] void time_panel(Session& /*session*/) { ImGui::TextDisabled("–"); }

namespace {
[[noreturn]] void refuse() { throw Error("export", "nothing can be written yet"); }
}  // namespace

[[gnu::weak]] void write_png(const std::filesystem::path&, const Pixels&) { refuse(); }
[[gnu::weak]] std::filesystem::path numbered(const std::filesystem::path&, std::uint64_t,
                                             std::uint64_t) {
  refuse();
}
[[gnu::weak]] void write_csv(const std::filesystem::path&, const ShownField&, const PillarRect&) {
  refuse();
}
struct VideoWriter::State {};
[[gnu::weak]] VideoWriter::VideoWriter(const std::filesystem::path&, std::uint32_t, std::uint32_t,
                                       double) {
  refuse();
}
[[gnu::weak]] VideoWriter::~VideoWriter() = default;
[[gnu::weak]] void VideoWriter::add(const Pixels&) { refuse(); }
[[gnu::weak]] void VideoWriter::finish() { refuse(); }

}  // namespace pillarfield::viewer
