// The one place that knows GLFW: a window, its events as ui::Event, its Vulkan surface. One window a process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <vulkan/vulkan_core.h>

#include "runtime/base/result.h"
#include "ui/ui.h"

struct GLFWwindow;

namespace loam::window {

class Platform {
  public:
    static Result<std::unique_ptr<Platform>> create(const std::string& title, int width, int height);
    ~Platform();
    Platform(const Platform&) = delete;

    [[nodiscard]] static std::vector<const char*> instance_extensions();
    Result<VkSurfaceKHR> create_surface(VkInstance instance);

    // Waits until an event comes or so many seconds have passed; 0: only looks.
    void wait(double seconds);
    [[nodiscard]] std::vector<ui::Event> take_events();
    [[nodiscard]] bool has_events() const { return !events_.empty() || exposed_; }
    // True once after the window system asked for the picture again, or the size changed.
    [[nodiscard]] bool take_exposed();
    [[nodiscard]] bool should_close() const;

    [[nodiscard]] glm::uvec2 size_px() const; // of the framebuffer
    [[nodiscard]] float content_scale() const;
    [[nodiscard]] double now_s() const;
    void set_cursor(ui::Cursor cursor);
    void set_title(const std::string& title);
    [[nodiscard]] ui::Clipboard clipboard();

  private:
    Platform() = default;
    void install_callbacks();
    [[nodiscard]] ui::Vec2 to_px(double x, double y) const;

    GLFWwindow* window_ = nullptr;
    std::vector<ui::Event> events_;
    bool exposed_ = true;
    ui::Cursor shown_cursor_ = ui::Cursor::arrow;
    void* cursors_[6] = {};
    struct Callbacks;
    friend struct Callbacks;
};

} // namespace loam::window
