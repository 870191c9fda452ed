// The scene's picture under the interface. Scalar layout, 4-byte members.
#ifndef LOAM_SHADERS_UI_VIEWPORT_IO_H
#define LOAM_SHADERS_UI_VIEWPORT_IO_H

#ifdef __cplusplus
namespace loam::ui {
#endif

struct ViewportPush {
    float origin_x, origin_y;  // of the viewport in the window, pixels
    float scale_x, scale_y;    // picture texels a window pixel
    float size_x, size_y;      // filled part of the picture, texels
};

#ifdef __cplusplus
}  // namespace loam::ui
#endif
#endif
