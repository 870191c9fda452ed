// Layout of the context: a stack of rows and columns. What a row's content cells want is remembered from the
// frame before; when it changes, another frame is asked for.
#include "ui/ui_private.h"

#include <cmath>

#include "runtime/base/check.h"

namespace loam::ui {

void Ui::push_layout(const Rect& area, bool is_row, float gap) {
    Layout l;
    l.area = area;
    l.is_row = is_row;
    l.gap = gap < 0 ? px(is_row ? theme.gap : theme.row_gap) : px(gap);
    l.cursor = l.end = is_row ? area.x : area.y;
    layouts_.push_back(std::move(l));
}

void Ui::pop_layout() {
    LOAM_CHECK(layouts_.size() > 1, "a layout scope was closed twice");
    Layout& l = layouts_.back();
    if (l.memory != 0) {
        auto& remembered = state<RowMemory>(l.memory);
        if (remembered.wanted != l.wanted) {
            remembered.wanted = l.wanted;
            request_redraw();
        }
    }
    if (l.spring_memory != 0) {
        float& width = state<SpringMemory>(l.spring_memory).width;
        if (const float now = l.end - l.spring_start; now != width) {
            width = now;
            request_redraw();
        }
    }
    layouts_.pop_back();
}

Scope Ui::row(std::initializer_list<Size> sizes, float height) {
    Layout& parent = layouts_.back();
    // Rows have no label: their place in the parent names their memory.
    const Id memory = (ids_.back() ^ 0x9E3779B97F4A7C15ull) * 1099511628211ull + uint64_t(parent.serial++) +
                      uint64_t(layouts_.size()) * 977;
    const Rect area = allocate({parent.area.w, px(height > 0 ? height : theme.control_height)});
    push_layout(area, true, -1);
    Layout& l = layouts_.back();
    l.memory = memory;
    l.wanted.assign(sizes.size(), 0.0f);
    l.cells = solve({.sizes = {sizes.begin(), sizes.size()},
                     .content_px = state<RowMemory>(memory).wanted,
                     .available_px = area.w,
                     .gap_px = l.gap,
                     .scale = theme.scale});
    return Scope(*this, [](Ui& u) { u.pop_layout(); });
}

Scope Ui::flow(float height) {
    const Rect area = allocate({layouts_.back().area.w, px(height > 0 ? height : theme.control_height)});
    push_layout(area, true, -1);
    return Scope(*this, [](Ui& u) { u.pop_layout(); });
}

Scope Ui::column(float gap) {
    return column_in(allocate_rest(), gap);
}

Scope Ui::column_in(const Rect& area, float gap) {
    push_layout(area, false, gap);
    return Scope(*this, [](Ui& u) { u.pop_layout(); });
}

Scope Ui::row_in(const Rect& area, float gap) {
    push_layout(area, true, gap);
    return Scope(*this, [](Ui& u) { u.pop_layout(); });
}

Rect Ui::allocate(Vec2 wanted) {
    Layout& l = layouts_.back();
    if (!l.is_row) {
        const Rect r{l.area.x, l.cursor, l.area.w, std::ceil(std::max(0.0f, wanted.y))};
        l.end = r.bottom();
        l.cursor = l.end + l.gap;
        return r;
    }
    if (!l.cells.empty()) {
        LOAM_CHECK(l.next < l.cells.size(), "more widgets in a row than it has cells");
        const Extent cell = l.cells[l.next];
        l.wanted[l.next++] = std::ceil(wanted.x);
        l.end = l.area.x + cell.start + cell.length;
        return {l.area.x + cell.start, l.area.y, cell.length, l.area.h};
    }
    const Rect r{l.cursor, l.area.y, std::ceil(std::max(0.0f, wanted.x)), l.area.h};
    l.end = r.right();
    l.cursor = l.end + l.gap;
    return r;
}

Rect Ui::allocate_rest() {
    Layout& l = layouts_.back();
    if (l.is_row && !l.cells.empty()) return allocate({});
    const Rect rest = remaining();
    return allocate({rest.w, rest.h});
}

Rect Ui::remaining() const {
    const Layout& l = layouts_.back();
    if (l.is_row && !l.cells.empty()) {
        if (l.next >= l.cells.size()) return {l.area.right(), l.area.y, 0, l.area.h};
        return {l.area.x + l.cells[l.next].start, l.area.y, l.cells[l.next].length, l.area.h};
    }
    if (l.is_row) return {l.cursor, l.area.y, std::max(0.0f, l.area.right() - l.cursor), l.area.h};
    return {l.area.x, l.cursor, l.area.w, std::max(0.0f, l.area.bottom() - l.cursor)};
}

void Ui::space(float logical) {
    Layout& l = layouts_.back();
    l.cursor += px(logical);
    l.end = std::max(l.end, l.cursor - l.gap);
}

// The width of what follows is known from the last frame, like a content cell's.
void Ui::spring() {
    Layout& l = layouts_.back();
    LOAM_CHECK(l.is_row && l.cells.empty(), "spring belongs into a flow");
    const Id id = (ids_.back() + 0x51ED270B0A1F39C1ull) * 1099511628211ull + uint64_t(layouts_.size());
    l.spring_memory = id;
    l.spring_start = std::max(l.cursor, l.area.right() - state<SpringMemory>(id).width);
    l.cursor = l.end = l.spring_start;
}

bool Ui::in_column() const {
    return !layouts_.back().is_row;
}

float Ui::content_end() const {
    return layouts_.back().end;
}

}  // namespace loam::ui
