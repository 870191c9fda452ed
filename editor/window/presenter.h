// Puts a frame on screen: the scene's picture into the viewport, the interface over it, both into one image of the
// window. The scene is drawn anew only when asked to; the last picture stays for frames of the interface alone.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <unordered_map>

#include "editor/session.h"
#include "runtime/gpu/swapchain.h"
#include "ui/renderer.h"

namespace loam::window {

struct SceneFrame {
    Renderer* renderer = nullptr;
    Camera camera;
    FrameSettings settings;
    bool draw = false; // else the picture there is
    ui::Rect viewport; // physical px
};

class Presenter {
  public:
    // The surface belongs to the presenter from here on.
    static Result<std::unique_ptr<Presenter>> create(Session& session, VkSurfaceKHR surface, glm::uvec2 size_px);
    ~Presenter();
    Presenter(const Presenter&) = delete;

    [[nodiscard]] ui::UiRenderer& ui() { return *ui_; }
    // A layer's RGBA8 picture for the palette: a new one where `id` is 0, else in place of the one there.
    Result<ui::TextureId> set_picture(ui::TextureId id, std::span<const uint8_t> rgba, uint32_t side);

    // False when the window has no area (minimised): nothing was drawn.
    Result<bool> draw(glm::uvec2 size_px, const ui::DrawList& list, ui::GlyphAtlas& atlas, ui::Color background,
                      const std::optional<SceneFrame>& scene);

  private:
    explicit Presenter(Session& session) : session_(session) {}
    Status make_pipelines();
    void cmd_draw_picture(gpu::Commands& commands, const SceneFrame& scene);

    Session& session_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    std::unique_ptr<gpu::Swapchain> swapchain_;
    std::optional<ui::UiRenderer> ui_;
    gpu::Pipeline same_size_, filtered_;
    gpu::Sampler nearest_, linear_;
    std::unordered_map<ui::TextureId, gpu::Image> pictures_;
};

} // namespace loam::window
