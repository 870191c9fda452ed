#include "editor/window/platform_glfw.h"

#include <cmath>

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

namespace loam::window {

namespace {

using ui::Key;

ui::Mods mods_of(int bits) {
    return {.ctrl = (bits & GLFW_MOD_CONTROL) != 0,
            .shift = (bits & GLFW_MOD_SHIFT) != 0,
            .alt = (bits & GLFW_MOD_ALT) != 0,
            .super = (bits & GLFW_MOD_SUPER) != 0};
}

// GLFW names keys by their place on a US keyboard; letters follow the layout in use.
Key key_of(int key, int scancode) {
    const auto offset = [](Key first, int by) { return Key(int(first) + by); };
    if (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) {
        const char* name = glfwGetKeyName(key, scancode);
        if (name && name[0] >= 'a' && name[0] <= 'z' && name[1] == 0) return offset(Key::a, name[0] - 'a');
        return offset(Key::a, key - GLFW_KEY_A);
    }
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) return offset(Key::digit_0, key - GLFW_KEY_0);
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return offset(Key::digit_0, key - GLFW_KEY_KP_0);
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return offset(Key::f1, key - GLFW_KEY_F1);
    switch (key) {
        case GLFW_KEY_LEFT: return Key::left;
        case GLFW_KEY_RIGHT: return Key::right;
        case GLFW_KEY_UP: return Key::up;
        case GLFW_KEY_DOWN: return Key::down;
        case GLFW_KEY_HOME: return Key::home;
        case GLFW_KEY_END: return Key::end;
        case GLFW_KEY_PAGE_UP: return Key::page_up;
        case GLFW_KEY_PAGE_DOWN: return Key::page_down;
        case GLFW_KEY_INSERT: return Key::insert;
        case GLFW_KEY_DELETE: return Key::del;
        case GLFW_KEY_BACKSPACE: return Key::backspace;
        case GLFW_KEY_TAB: return Key::tab;
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER: return Key::enter;
        case GLFW_KEY_ESCAPE: return Key::escape;
        case GLFW_KEY_SPACE: return Key::space;
        case GLFW_KEY_MINUS:
        case GLFW_KEY_KP_SUBTRACT: return Key::minus;
        case GLFW_KEY_EQUAL:
        case GLFW_KEY_KP_ADD: return Key::equal;
        case GLFW_KEY_COMMA: return Key::comma;
        case GLFW_KEY_PERIOD: return Key::period;
        case GLFW_KEY_SLASH: return Key::slash;
        case GLFW_KEY_SEMICOLON: return Key::semicolon;
        case GLFW_KEY_APOSTROPHE: return Key::apostrophe;
        case GLFW_KEY_LEFT_BRACKET: return Key::left_bracket;
        case GLFW_KEY_RIGHT_BRACKET: return Key::right_bracket;
        case GLFW_KEY_BACKSLASH: return Key::backslash;
        case GLFW_KEY_GRAVE_ACCENT: return Key::grave;
        default: return Key::none;
    }
}

// GLFW reports the modifiers as they were before the key itself; for a modifier key they must be as after it.
int mods_after(int key, int action, int mods) {
    const int bit = key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL ? GLFW_MOD_CONTROL
                    : key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT   ? GLFW_MOD_SHIFT
                    : key == GLFW_KEY_LEFT_ALT || key == GLFW_KEY_RIGHT_ALT       ? GLFW_MOD_ALT
                    : key == GLFW_KEY_LEFT_SUPER || key == GLFW_KEY_RIGHT_SUPER   ? GLFW_MOD_SUPER
                                                                                  : 0;
    return action == GLFW_RELEASE ? mods & ~bit : mods | bit;
}

int cursor_shape(ui::Cursor cursor) {
    switch (cursor) {
        case ui::Cursor::arrow: return GLFW_ARROW_CURSOR;
        case ui::Cursor::hand: return GLFW_HAND_CURSOR;
        case ui::Cursor::text: return GLFW_IBEAM_CURSOR;
        case ui::Cursor::resize_x: return GLFW_HRESIZE_CURSOR;
        case ui::Cursor::resize_y: return GLFW_VRESIZE_CURSOR;
        case ui::Cursor::crosshair: return GLFW_CROSSHAIR_CURSOR;
    }
    return GLFW_ARROW_CURSOR;
}

Error last_error(std::string_view what) {
    const char* text = nullptr;
    glfwGetError(&text);
    return error("{}: {}", what, text ? text : "no reason given");
}

} // namespace

struct Platform::Callbacks {
    static Platform& of(GLFWwindow* window) { return *static_cast<Platform*>(glfwGetWindowUserPointer(window)); }

    static void move(GLFWwindow* w, double x, double y) {
        Platform& p = of(w);
        const ui::Event event = ui::Event::move(p.to_px(x, y));
        // Moves between two frames are one: the tools join positions by straight lines.
        if (!p.events_.empty() && p.events_.back().type == ui::Event::Type::mouse_move) p.events_.back() = event;
        else p.events_.push_back(event);
    }
    static void enter(GLFWwindow* w, int entered) {
        if (!entered) of(w).events_.push_back(ui::Event::leave());
    }
    static void button(GLFWwindow* w, int button, int action, int mods) {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        const auto which = button == GLFW_MOUSE_BUTTON_LEFT    ? ui::MouseButton::left
                           : button == GLFW_MOUSE_BUTTON_RIGHT ? ui::MouseButton::right
                                                               : ui::MouseButton::middle;
        double x = 0, y = 0;
        glfwGetCursorPos(w, &x, &y);
        Platform& p = of(w);
        const ui::Vec2 at = p.to_px(x, y);
        p.events_.push_back(action == GLFW_PRESS ? ui::Event::press(at, which, mods_of(mods))
                                                 : ui::Event::release(at, which, mods_of(mods)));
    }
    static void scroll(GLFWwindow* w, double x, double y) {
        int mods = 0;
        for (const auto& [key, bit] : {std::pair{GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL},
                                       std::pair{GLFW_KEY_RIGHT_CONTROL, GLFW_MOD_CONTROL},
                                       std::pair{GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT},
                                       std::pair{GLFW_KEY_RIGHT_SHIFT, GLFW_MOD_SHIFT},
                                       std::pair{GLFW_KEY_LEFT_ALT, GLFW_MOD_ALT}})
            if (glfwGetKey(w, key) == GLFW_PRESS) mods |= bit;
        of(w).events_.push_back(ui::Event::scroll({float(x), float(y)}, mods_of(mods)));
    }
    static void key(GLFWwindow* w, int key, int scancode, int action, int mods) {
        const ui::Mods m = mods_of(mods_after(key, action, mods));
        const Key k = key_of(key, scancode);
        of(w).events_.push_back(action == GLFW_RELEASE ? ui::Event::key_up(k, m)
                                                       : ui::Event::key_down(k, m, action == GLFW_REPEAT));
    }
    static void character(GLFWwindow* w, unsigned codepoint) {
        of(w).events_.push_back(ui::Event::character(char32_t(codepoint)));
    }
    static void focus(GLFWwindow* w, int focused) {
        if (!focused) of(w).events_.push_back(ui::Event::blur());
    }
    static void refresh(GLFWwindow* w) { of(w).exposed_ = true; }
    static void resize(GLFWwindow* w, int, int) { of(w).exposed_ = true; }
};

Result<std::unique_ptr<Platform>> Platform::create(const std::string& title, int width, int height) {
    if (!glfwInit()) return last_error("cannot open a window (no display?)");
    std::unique_ptr<Platform> made(new Platform());
    if (!glfwVulkanSupported()) return error("cannot open a window: the Vulkan loader has no surface for this display");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    made->window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!made->window_) return last_error("cannot open a window");
    glfwSetWindowSizeLimits(made->window_, 640, 400, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(made->window_, made.get());
    made->install_callbacks();
    for (int i = 0; i < 6; ++i) made->cursors_[i] = glfwCreateStandardCursor(cursor_shape(ui::Cursor(i)));
    return made;
}

Platform::~Platform() {
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
}

void Platform::install_callbacks() {
    glfwSetCursorPosCallback(window_, Callbacks::move);
    glfwSetCursorEnterCallback(window_, Callbacks::enter);
    glfwSetMouseButtonCallback(window_, Callbacks::button);
    glfwSetScrollCallback(window_, Callbacks::scroll);
    glfwSetKeyCallback(window_, Callbacks::key);
    glfwSetCharCallback(window_, Callbacks::character);
    glfwSetWindowFocusCallback(window_, Callbacks::focus);
    glfwSetWindowRefreshCallback(window_, Callbacks::refresh);
    glfwSetFramebufferSizeCallback(window_, Callbacks::resize);
}

ui::Vec2 Platform::to_px(double x, double y) const {
    int width = 0, height = 0, px_width = 0, px_height = 0;
    glfwGetWindowSize(window_, &width, &height);
    glfwGetFramebufferSize(window_, &px_width, &px_height);
    return {float(x * px_width / std::max(1, width)), float(y * px_height / std::max(1, height))};
}

std::vector<const char*> Platform::instance_extensions() {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return names ? std::vector<const char*>(names, names + count) : std::vector<const char*>();
}

Result<VkSurfaceKHR> Platform::create_surface(VkInstance instance) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS)
        return last_error("cannot draw into the window");
    return surface;
}

void Platform::wait(double seconds) {
    if (seconds <= 0) glfwPollEvents();
    else if (std::isinf(seconds)) glfwWaitEvents();
    else glfwWaitEventsTimeout(seconds);
}

std::vector<ui::Event> Platform::take_events() {
    return std::exchange(events_, {});
}

bool Platform::take_exposed() {
    return std::exchange(exposed_, false);
}

bool Platform::should_close() const {
    return glfwWindowShouldClose(window_) != 0;
}

glm::uvec2 Platform::size_px() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {unsigned(std::max(0, width)), unsigned(std::max(0, height))};
}

float Platform::content_scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::clamp(std::round(std::max(x, y) * 4) / 4, 1.0f, 4.0f);
}

double Platform::now_s() const {
    return glfwGetTime();
}

void Platform::set_cursor(ui::Cursor cursor) {
    if (cursor == shown_cursor_) return;
    shown_cursor_ = cursor;
    glfwSetCursor(window_, static_cast<GLFWcursor*>(cursors_[size_t(cursor)]));
}

void Platform::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

ui::Clipboard Platform::clipboard() {
    return {.get =
                [](void* user) {
                    const char* text = glfwGetClipboardString(static_cast<GLFWwindow*>(user));
                    return std::string(text ? text : "");
                },
            .set =
                [](void* user, std::string_view text) {
                    glfwSetClipboardString(static_cast<GLFWwindow*>(user), std::string(text).c_str());
                },
            .user = window_};
}

} // namespace loam::window
