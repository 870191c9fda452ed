// Moves a camera by what mouse and keyboard say: fly, orbit, pan, zoom, frame a spot. No window, no device.
//
// Lengths follow the height above the ground, so that one feel serves from 1 m to 10 km: flying crosses about the
// height above ground in a second, zooming takes a share of the distance to what is under the cursor.
#pragma once

#include <functional>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/frame/camera.h"

namespace loam::window {

struct CameraInput {
    enum class Drag { none, look, orbit, pan };
    Drag drag = Drag::none;
    glm::dvec2 moved_px{0, 0};   // of the mouse while dragging, y down
    glm::dvec2 cursor_px{0, 0};  // in the picture
    glm::dvec2 picture_px{1, 1};
    std::optional<glm::dvec3> under_cursor; // ground there
    double wheel = 0;            // notches, away is positive
    // Flying, while looking: -1 … 1.
    double ahead = 0, right = 0, up = 0;
    bool fast = false;
    double dt_s = 0;
};

class CameraController {
  public:
    using HeightAt = std::function<double(double x_m, double y_m)>;
    CameraController(const Camera& camera, HeightAt height_at);

    // Takes one frame's input; true when the camera moved.
    bool update(const CameraInput& input);
    // Something still moves by itself: a flight that comes to rest, the way to a framed spot.
    [[nodiscard]] bool moving() const;
    [[nodiscard]] const Camera& camera() const { return camera_; }
    void set_camera(const Camera& camera);
    // Flies to a place from which `radius_m` around `target` fills a good part of the picture.
    void frame(glm::dvec3 target_m, double radius_m);
    // Jumps there, once arrive() says that all is ready or after kLongestWait_s.
    void jump_to(const Camera& camera);
    void arrive();
    // Where a flight or a jump ends; nothing while the camera is steered or rests.
    [[nodiscard]] std::optional<Camera> destination() const;
    void stop();

    bool keep_above_ground = true;
    [[nodiscard]] double speed_factor() const { return speed_factor_; } // set with the wheel while flying
    [[nodiscard]] double speed_m_s() const;                             // without `fast`

    static constexpr double kClearance_m = 0.3;
    static constexpr double kLongestWait_s = 0.4; // longer and the key seems to do nothing

  private:
    void look(glm::dvec2 moved_px);
    void orbit(glm::dvec2 moved_px);
    void pan(const CameraInput& input);
    void zoom(const CameraInput& input);
    bool fly(const CameraInput& input);
    bool advance_flight(double dt_s);
    bool advance_jump(double dt_s);
    bool rise_above_ground();
    [[nodiscard]] double height_above_ground_m() const;
    [[nodiscard]] glm::dvec3 point_ahead() const; // stands in for the ground when the cursor is on the sky

    Camera camera_;
    HeightAt height_at_;
    CameraInput::Drag drag_ = CameraInput::Drag::none;
    glm::dvec3 pivot_m_{0};       // of the drag: what orbit turns around, what pan holds
    glm::dvec3 velocity_m_s_{0};
    double speed_factor_ = 1;
    struct Flight {
        glm::dvec3 from_m, to_m;
        double from_pitch, to_pitch, at_s = 0;
    };
    std::optional<Flight> flight_;
    struct Jump {
        Camera to;
        double waited_s = 0;
    };
    std::optional<Jump> jump_;
};

} // namespace loam::window
