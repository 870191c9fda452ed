// The outliner: every operator of the document, the last evaluated first, to find, show, hide, order and
// remove.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

constexpr size_t kMostRows = 200;  // shown at once; the search finds the others
constexpr float kRow = 24, kMostHeight = 260;

std::string detail_of(const OperatorShape& shape) {
    if (const auto* stamp = std::get_if<Stamp>(&shape)) return stamp->image;
    if (const auto* cutout = std::get_if<Cutout>(&shape)) return cutout->fill ? "closes" : "";
    const DecalMaterial* material = material_of(shape);
    if (!material) return {};
    return material->function.empty() ? material->layer : material->function;
}

// When it is there, and until when it moves.
void add_times(const Operator& op, ObjectRow& row) {
    const auto* event = std::get_if<Event>(&op.shape);
    row.timed = event || !op.life.ever();
    if (event) {
        row.from_s = event->start_s;
        row.moved_s = event->start_s + event->duration_s;
        row.until_s = end_s(*event);
    } else if (row.timed) {
        const Life& life = op.life;
        row.from_s = std::isfinite(life.from_s) ? life.from_s : 0;
        row.moved_s = row.from_s + life.rise_s;
        row.until_s = std::isfinite(life.until_s)
                          ? life.until_s
                          : row.from_s + std::max({life.rise_s, life.cool_s, life.weather_s});
    }
}

ObjectRow row_of(const Operator& op) {
    const std::string detail = detail_of(op.shape);
    ObjectRow row{
        .id = op.id,
        .order = op.order,
        .title = fmt::format("{} {}{}{}", kind_title(op.shape), op.id, detail.empty() ? "" : " · ", detail),
        .enabled = op.enabled,
        .bounds = op.extent()};
    add_times(op, row);
    return row;
}

bool found(const std::string& title, const std::string& search) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(title.begin(), title.end(), search.begin(), search.end(), same) != title.end();
}

void object_row(App& app, ui::Ui& ui, const ObjectRow& object) {
    auto row = ui.row({ui::fixed(kRow), ui::flex()}, kRow);
    const std::string eye = fmt::format("eye{}", object.id);
    if (ui::icon_button(ui, eye,
                        {.icon = object.enabled ? ui::Icon::eye : ui::Icon::eye_off,
                         .tooltip = object.enabled ? "Hide" : "Show",
                         .size = 20}))
        app.show_object(object.id, !object.enabled);
    const ui::Rect place = ui.allocate({0, ui.px(kRow)});
    const ui::Response r =
        ui.interact(ui.make_id(fmt::format("object{}", object.id)), place, ui::Sense::click);
    const ui::Theme& theme = ui.theme;
    if (object.id == app.selected_object)
        ui.draw().rect(place, theme.accent_soft, ui.px(3));
    else if (r.hovered)
        ui.draw().rect(place, theme.hover, ui.px(3));
    ui.draw_label(place.inset(ui.px(6), 0), object.title, ui.style(),
                  object.enabled ? theme.text : theme.text_disabled);
    if (!r.clicked) return;
    app.selected_object = object.id == app.selected_object ? 0 : object.id;
    ui.request_redraw();  // it was drawn already
}

}  // namespace

// Kept while a stroke goes on: of many objects the list is long, and the stroke's own are not looked for. All
// are read when the list is first looked at, then those that change.
const std::vector<ObjectRow>& App::objects() {
    const Document& document = session.document();
    const uint64_t revision = document.revision();
    if (objects_revision_ == revision || tools.stroking()) return objects_;
    const auto changed = objects_revision_ ? document.changed_operators(*objects_revision_) : std::nullopt;
    objects_revision_ = revision;
    if (!changed) {
        const std::vector<Operator> operators = document.operators();
        objects_.clear();
        for (auto op = operators.rbegin(); op != operators.rend(); ++op) objects_.push_back(row_of(*op));
        return objects_;
    }
    if (changed->empty()) return objects_;
    std::erase_if(objects_, [&](const ObjectRow& row) {
        return std::binary_search(changed->begin(), changed->end(), row.id);
    });
    const auto before = [](const ObjectRow& a, const ObjectRow& b) {
        return std::pair(a.order, a.id) > std::pair(b.order, b.id);
    };
    const ptrdiff_t kept = ptrdiff_t(objects_.size());
    for (const uint64_t id : *changed)
        if (const auto op = document.find_operator(id)) objects_.push_back(row_of(*op));
    std::sort(objects_.begin() + kept, objects_.end(), before);
    std::inplace_merge(objects_.begin(), objects_.begin() + kept, objects_.end(), before);
    return objects_;
}

const std::vector<ObjectRow>& App::timed_objects() {
    const uint64_t revision = session.document().revision();
    if (timed_objects_revision_ == revision || tools.stroking()) return timed_objects_;
    timed_objects_revision_ = revision;
    timed_objects_.clear();
    // Prints are too many for bars.
    for (const Operator& op : session.document().timed_operators())
        if (!std::holds_alternative<Footprint>(op.shape)) timed_objects_.push_back(row_of(op));
    std::stable_sort(timed_objects_.begin(), timed_objects_.end(),
                     [](const ObjectRow& a, const ObjectRow& b) { return a.from_s < b.from_s; });
    return timed_objects_;
}

const Operator* App::selected_operator() {
    if (selected_operator_revision_ != session.document().revision() || !selected_operator_ ||
        selected_operator_->id != selected_object) {
        selected_operator_revision_ = session.document().revision();
        selected_operator_ = session.document().find_operator(selected_object);
        if (selected_operator_) selected_row_ = row_of(*selected_operator_);
    }
    return selected_operator_ ? &*selected_operator_ : nullptr;
}

const ObjectRow* App::selected_row() {
    return selected_operator() ? &selected_row_ : nullptr;
}

void App::show_object(uint64_t id, bool shown) {
    apply({.body = SetOperatorCommand{.id = id, .enabled = shown}});
}

void App::remove_object(uint64_t id) {
    if (apply({.body = RemoveOperatorCommand{id}})) selected_object = 0;
}

// The two change places in the order of evaluation.
void App::move_object(uint64_t id, bool later) {
    const std::vector<ObjectRow> rows = objects();
    const auto at = std::find_if(rows.begin(), rows.end(), [&](const ObjectRow& r) { return r.id == id; });
    if (at == rows.end() || (later ? at == rows.begin() : at + 1 == rows.end())) return;
    const ObjectRow& other = later ? *(at - 1) : *(at + 1);
    const uint64_t group = session.document().next_group();
    // Of one order the id decides: the later of the two goes a step beyond.
    if (other.order == at->order) {
        const ObjectRow& moved = later ? *at : other;
        apply({.body = ReorderCommand{.id = moved.id, .order = moved.order + 1}, .group = group});
        return;
    }
    if (apply({.body = ReorderCommand{.id = id, .order = other.order}, .group = group}))
        apply({.body = ReorderCommand{.id = other.id, .order = at->order}, .group = group});
}

void App::frame_object() {
    const ObjectRow* row = selected_row();
    if (!row) return;
    const glm::dvec2 centre = row->bounds.center();
    camera.frame(glm::dvec3(centre, height_at(centre.x, centre.y)),
                 std::max({row->bounds.width() / 2, row->bounds.height() / 2, 1.0}));
    scene_changed();
}

void object_properties(App& app, ui::Ui& ui) {
    const std::vector<ObjectRow>& rows = app.objects();
    if (rows.empty()) return ui::label(ui, "No craters, decals, roads, cutouts or events yet", ui::Tone::dim);
    ui::text_field(ui, "##objects", app.object_search,
                   {.placeholder = fmt::format("Search {} objects", rows.size()), .icon = ui::Icon::search});
    std::vector<const ObjectRow*> shown;
    size_t matches = 0;
    for (const ObjectRow& row : rows) {
        if (!found(row.title, app.object_search)) continue;
        if (++matches <= kMostRows) shown.push_back(&row);
    }
    if (matches == 0)
        ui::label(ui, fmt::format("No object has \"{}\" in its name", app.object_search), ui::Tone::dim);
    if (!shown.empty()) {
        auto list = ui::scroll_area(ui, "objects",
                                    std::min(float(shown.size()) * (kRow + ui.theme.row_gap), kMostHeight));
        for (const ObjectRow* row : shown) object_row(app, ui, *row);
    }
    if (matches > shown.size())
        ui::label(ui, fmt::format("and {} more: search for them", matches - shown.size()), ui::Tone::dim);
    const ObjectRow* selected = app.selected_row();
    ui.push_disabled(!selected);
    {
        auto row = ui.row({ui::flex(), ui::flex(), ui::flex(), ui::fixed(28)});
        const uint64_t id = selected ? selected->id : 0;
        if (ui::button(ui, "Later",
                       {.tooltip = "After the one above: over it, in heights and among its kind"}))
            app.move_object(id, true);
        if (ui::button(ui, "Earlier")) app.move_object(id, false);
        if (ui::button(ui, "Frame")) app.frame_object();
        if (ui::icon_button(ui, "remove object",
                            {.icon = ui::Icon::trash, .tooltip = "Remove", .shortcut = "Delete", .size = 26}))
            app.remove_object(id);
    }
    ui.pop_disabled();
    selected_event_properties(app, ui);
    selected_decal_properties(app, ui);
}

}  // namespace loam::window
