// The brush's outline: a polygon on the ground, projected and drawn as lines of the interface. What hills hide is drawn
// faintly, so that the brush is never lost and depth can still be read.
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

constexpr int kCorners = 72;
constexpr int kHiddenEvery = 3;           // a ray for every third corner: hills are wider than that
constexpr double kExactRadius_m = 48;     // beyond it, heights come from the base map's coarser samples

struct Corner {
    ui::Vec2 at;
    bool in_front = false, hidden = false;
};

// Height for a far reaching ring: the sample of the base map that is about as coarse as the ring's corners, so that a ring
// of any size costs the same and composes no pages.
class CoarseHeights {
  public:
    CoarseHeights(const Document& document, double step_m) : document_(document), lock_(document.read_lock()) {
        while (mip_ + 1 < document.height_mip_count() && spacing() * 2 <= step_m) ++mip_;
    }
    [[nodiscard]] double at(glm::dvec2 p) const {
        const double x = p.x / spacing(), y = p.y / spacing();
        const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
        int32_t mm[4];
        document_.read_heights_mm(mip_, i, j, 2, 2, mm);
        const double fx = x - i, fy = y - j;
        const double south = mm[0] + (mm[1] - mm[0]) * fx, north = mm[2] + (mm[3] - mm[2]) * fx;
        return (south + (north - south) * fy) * 0.001;
    }

  private:
    [[nodiscard]] double spacing() const { return document_.settings().height_spacing_m * double(1 << mip_); }
    const Document& document_;
    Document::ReadLock lock_;
    int mip_ = 0;
};

std::vector<glm::dvec3> ring_places(App& app, glm::dvec2 center, double radius) {
    const bool exact = radius <= kExactRadius_m;
    std::vector<glm::dvec3> places(kCorners);
    std::optional<CoarseHeights> coarse;
    if (!exact) coarse.emplace(app.session.document(), radius * 2 * M_PI / kCorners * 0.5);
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * M_PI * i / kCorners;
        const glm::dvec2 p = center + radius * glm::dvec2(std::cos(angle), std::sin(angle));
        places[size_t(i)] = glm::dvec3(p, exact ? app.height_at(p.x, p.y) : coarse->at(p));
    }
    return places;
}

// A line over the ground. `reach_m`: how far from the ground a place may seem to be and still count as on it.
void draw_line(App& app, ui::Ui& ui, const ui::Rect& viewport, const std::vector<glm::dvec3>& places, bool closed,
               double reach_m, ui::Color color) {
    const Camera& camera = app.camera.camera();
    const int count = int(places.size());
    std::vector<Corner> corners(places.size());
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 offset = places[size_t(i)] - camera.position_m;
        const auto seen = camera.pixel_of(places[size_t(i)], viewport.w, viewport.h);
        Corner& corner = corners[size_t(i)];
        corner.in_front = seen.has_value();
        if (!seen) continue;
        corner.at = {viewport.x + float(seen->x), viewport.y + float(seen->y)};
        if (i % kHiddenEvery != 0) {
            corner.hidden = corners[size_t(i - 1)].hidden;
            continue;
        }
        const double distance = glm::length(offset), tolerance = 0.01 * distance + 0.02 * reach_m + 0.05;
        const auto hit = app.session.ray_cast(camera.position_m, offset / distance, distance - tolerance);
        corner.hidden = hit && hit->has_value();
    }
    const float width = ui.px(1.5f);
    const int lines = closed ? count : count - 1;
    for (int i = 0; i < lines; ++i) {
        const Corner &a = corners[size_t(i)], &b = corners[size_t((i + 1) % count)];
        if (!a.in_front || !b.in_front) continue;
        const float opacity = a.hidden ? 0.25f : 1.0f;
        ui.draw().line(a.at, b.at, ui::Color::hex(0x000000, 130).faded(opacity), width + ui.px(1.5f));
    }
    for (int i = 0; i < lines; ++i) {
        const Corner &a = corners[size_t(i)], &b = corners[size_t((i + 1) % count)];
        if (!a.in_front || !b.in_front) continue;
        ui.draw().line(a.at, b.at, color.faded(a.hidden ? 0.25f : 1.0f), width);
    }
}

void draw_handles(App& app, ui::Ui& ui, const ui::Rect& viewport) {
    const Camera& camera = app.camera.camera();
    const auto pixel_of = [&](glm::dvec2 at) -> std::optional<ui::Vec2> {
        const auto seen = camera.pixel_of({at, app.height_at(at.x, at.y)}, viewport.w, viewport.h);
        if (!seen) return {};
        return ui::Vec2{viewport.x + float(seen->x), viewport.y + float(seen->y)};
    };
    const std::vector<Handle>& handles = app.handles();
    for (int pass = 0; pass < 2; ++pass)  // lines below all dots
        for (size_t i = 0; i < handles.size(); ++i) {
            const auto at = pixel_of(handles[i].at_m), from = pixel_of(handles[i].from_m);
            if (!at) continue;
            if (pass == 0) {
                if (from && handles[i].role != Handle::Role::anchor)
                    ui.draw().line(*from, *at, ui.theme.accent.faded(0.8f), ui.px(1.5f));
                continue;
            }
            const bool hot = int(i) == app.hot_handle(), small = handles[i].role == Handle::Role::tangent;
            const float radius = ui.px(small ? 4.0f : 6.0f);
            ui.draw().circle(*at, radius + ui.px(1.5f), ui::Color::hex(0x000000, 150));
            ui.draw().circle(*at, radius, hot ? ui.theme.text : ui.theme.accent);
        }
}

} // namespace

void draw_ring(App& app, ui::Ui& ui, const ui::Rect& viewport) {
    if (!app.view.show_ring) return;
    ui.draw().push_clip(viewport);
    for (const ToolController::Outline& outline : app.outlines()) {
        std::vector<glm::dvec3> places;
        for (const glm::dvec2& at : outline.places_m) places.emplace_back(at, app.height_at(at.x, at.y));
        draw_line(app, ui, viewport, places, outline.closed, app.tools.brush().radius_m, ui::Color::hex(0xffffff, 235));
    }
    draw_handles(app, ui, viewport);
    if (const auto ring = app.ring()) {
        const double radius = ring->radius_m, inner = radius * ring->inner_share;
        draw_line(app, ui, viewport, ring_places(app, ring->center_m, radius), true, radius,
                  ui::Color::hex(0xffffff, 235));
        if (ring->inner_share > 0.05)
            draw_line(app, ui, viewport, ring_places(app, ring->center_m, inner), true, inner,
                      ui::Color::hex(0xffffff, 110));
    }
    ui.draw().pop_clip();
}

} // namespace loam::window
