// Commands: compute on copies, one transaction, then show it. Undo and redo: the same swap of rows and
// images.
#include <algorithm>
#include <bit>

#include <glm/geometric.hpp>

#include "runtime/base/log.h"
#include "runtime/document/dirt.h"
#include "runtime/document/document_impl.h"
#include "runtime/document/laid_layer.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/paint.h"
#include "runtime/document/sculpt.h"
#include "runtime/document/slope.h"
#include "runtime/document/transitions.h"

namespace loam {

namespace {

// Readers outside the map see its nearest sample, so a changed sample at the edge changes all that lies
// beyond it. Farther than twice the largest map no page reaches.
constexpr double kBeyond_m = 65536;

// World rectangles that changed samples influence: `reach` spacings around them.
std::vector<WorldRect> dirt_of_samples(const MapShape& shape, const std::vector<TexelRect>& changed,
                                       int reach) {
    std::vector<WorldRect> rects;
    for (const TexelRect& r : changed)
        rects.push_back(WorldRect{r.x0 * shape.spacing_m, r.y0 * shape.spacing_m,
                                  (r.x1 - 1) * shape.spacing_m, (r.y1 - 1) * shape.spacing_m}
                            .grown(reach * shape.spacing_m));
    merge_rects(rects, kMaxStrokeRects);
    const double east = (shape.samples_x - 1) * shape.spacing_m,
                 north = (shape.samples_y - 1) * shape.spacing_m;
    const double near_edge = (reach - 0.5) * shape.spacing_m;
    for (WorldRect& rect : rects) {
        if (rect.min_x <= -near_edge) rect.min_x = -kBeyond_m;
        if (rect.min_y <= -near_edge) rect.min_y = -kBeyond_m;
        if (rect.max_x >= east + near_edge) rect.max_x = east + kBeyond_m;
        if (rect.max_y >= north + near_edge) rect.max_y = north + kBeyond_m;
    }
    return rects;
}

void add_page_images(std::vector<PageChange>& changes, std::vector<RowImage>& images) {
    for (PageChange& change : changes) images.push_back({RowImage::Kind::page, change.key, change.blob});
}

void merge_dirt(Dirt& dirt, size_t most) {
    merge_rects(dirt.height, most);
    merge_rects(dirt.index, most);
    merge_rects(dirt.texture, most);
    merge_rects(dirt.cutout, most);
}

}  // namespace

Status Document::Impl::compute(const SculptCommand& command, Change& change) {
    change.heights.emplace(*pages, height, settings.default_height_mm);
    LOAM_TRY(sculpt(command, *change.heights));
    std::vector<TexelRect> changed;
    auto result = change.heights->finish(changed);
    if (!result.ok()) return result.error();
    change.height_changes = std::move(*result);
    add_page_images(change.height_changes, change.images);
    change.dirt.height = dirt_of_samples(height, changed, 2);  // bicubic: two samples on either side
    return {};
}

Result<uint16_t> Document::Impl::layer_number(const std::string& name) const {
    LOAM_TRY(known_layer(name));
    uint16_t layer = 0;
    while (settings.layers[layer].name != name) ++layer;
    return layer;
}

// Both commands that paint: `run` does it.
template <typename PaintingCommand, typename Run>
Status Document::Impl::compute_paint(const PaintingCommand& command, PaintLayers layers, Change& change,
                                     Run&& run) {
    if (command.layer) {
        const auto number = layer_number(*command.layer);
        if (!number.ok()) return number.error();
        layers.layer = *number;
    }
    if (command.transitions) layers.transitions = transitions_of(settings);
    change.texels.emplace(*pages, index, default_texel(settings));
    SlopeReader ground(*pages, height, settings.default_height_mm);
    LOAM_TRY(run(command, layers, ground, *change.texels));
    std::vector<TexelRect> changed;
    auto result = change.texels->finish(changed);
    if (!result.ok()) return result.error();
    change.index_changes = std::move(*result);
    add_page_images(change.index_changes, change.images);
    change.dirt.index = dirt_of_samples(index, changed, 1);  // nearest or bilinear: one texel on either side
    return {};
}

Status Document::Impl::compute(const PaintCommand& command, Change& change) {
    return compute_paint(command, {}, change, paint);
}

Status Document::Impl::compute(const FillCommand& command, Change& change) {
    PaintLayers layers;
    if (command.replace) {
        const auto number = layer_number(*command.replace);
        if (!number.ok()) return number.error();
        layers.replace = *number;
    }
    return compute_paint(command, std::move(layers), change, fill);
}

// `op`: its new state, or none to remove it.
void Document::Impl::change_operator(uint64_t id, std::optional<Operator> op, Change& change) {
    if (op) {
        prepare(*op);
        // A stamp whose picture is gone can still be moved, switched and removed.
        (void)give_parts(*op);
    }
    RowImage image{RowImage::Kind::op, int64_t(id), std::nullopt};
    if (op) {
        const std::string json = operator_json(*op);
        image.bytes.emplace(json.begin(), json.end());
    }
    change.images.push_back(std::move(image));
    change.operators[id] = std::move(op);
}

Status Document::Impl::give_parts(Operator& op) {
    if (const LaidLayer laid = laid_layer(op.shape); laid.chosen()) {
        const auto number = layer_number(*laid.name);
        if (!number.ok()) return number.error();
        *laid.number = *number;
    }
    if (const DecalMaterial* material = material_of(op.shape); material && !material->function.empty()) {
        const auto function = functions->find(material->function);
        return function.ok() ? Status() : function.error();
    }
    auto* stamp = std::get_if<Stamp>(&op.shape);
    if (!stamp) return {};
    auto picture = stamps->find(stamp->image);
    if (!picture.ok()) return picture.error();
    stamp->picture = std::move(*picture);
    return {};
}

// Steepest descent of the base map's ground, at the scale of the scar, until it levels out.
Result<glm::dvec2> Document::Impl::run_out(const Event& landslide) {
    constexpr double kLevel = 0.08;  // a tangent: six parts in eighty metres
    SlopeReader ground(*pages, height, settings.default_height_mm);
    const double step_m = landslide.radius_m;
    glm::dvec2 at(landslide.x_m, landslide.y_m);
    for (int step = 0; step < 16; ++step) {
        double around_m[4];
        constexpr glm::dvec2 kTo[4] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        for (int i = 0; i < 4; ++i) {
            const glm::dvec2 place = at + step_m * kTo[i];
            const auto height_m = ground.height_m(place.x, place.y);
            if (!height_m.ok()) return height_m.error();
            around_m[i] = *height_m;
        }
        const glm::dvec2 down(around_m[1] - around_m[0], around_m[3] - around_m[2]);
        const double tangent = glm::length(down) / (2 * step_m);
        if (!(tangent > 0)) break;
        at += step_m * glm::normalize(down);
        if (tangent < kLevel) break;
    }
    return at;
}

Status Document::Impl::known_layer(const std::string& name) const {
    std::string known;
    for (const LayerEntry& entry : settings.layers) {
        if (entry.name == name) return {};
        if (!known.empty()) known += ", ";
        known += entry.name;
    }
    return error("unknown layer \"{}\" (known: {})", name, known.empty() ? "none" : known);
}

Status Document::Impl::known_parts(const OperatorShape& shape) const {
    OperatorShape copy = shape;
    if (const LaidLayer laid = laid_layer(copy); laid.chosen()) LOAM_TRY(known_layer(*laid.name));
    if (const auto* stamp = std::get_if<Stamp>(&shape)) {
        const auto picture = stamps->find(stamp->image);
        return picture.ok() ? Status() : picture.error();
    }
    const DecalMaterial* material = material_of(shape);
    if (!material || material->layer.empty()) return {};
    LOAM_TRY(known_layer(material->layer));
    const auto entry = std::find_if(settings.layers.begin(), settings.layers.end(),
                                    [&](const LayerEntry& e) { return e.name == material->layer; });
    if (entry->blend)
        return error(
            "a decal shows the texture of a layer, and \"{}\" is a transition without one: name a layer, such "
            "as \"{}\"",
            material->layer, entry->blend->to);
    return {};
}

Status Document::Impl::known_function(const OperatorShape& shape, const OperatorShape* before) {
    const DecalMaterial* material = material_of(shape);
    const DecalMaterial* old = before ? material_of(*before) : nullptr;
    if (!material || material->function.empty()) return {};
    if (old && old->function == material->function && old->parameters == material->parameters) return {};
    const auto function = functions->find(material->function);
    if (!function.ok()) return function.error();
    LOAM_TRY(check_parameters(**function, material->parameters));
    return functions->keep(material->function);
}

void Document::Impl::add_operator(OperatorShape shape, const Life& life, Change& change) {
    const uint64_t id = change.next_operator++;
    change_operator(id, Operator{.id = id, .order = id, .shape = std::move(shape), .life = life}, change);
}

Status Document::Impl::compute(const CraterCommand& command, Change& change) {
    add_operator(command.crater, command.life, change);
    return {};
}

Status Document::Impl::compute(const FootprintsCommand& command, Change& change) {
    const bool ends = command.life.until_s < Life::kEver_s;
    const size_t laid = ends && command.keep > 0 ? std::min<size_t>(command.prints.size(), command.keep)
                                                 : command.prints.size();
    for (size_t i = command.prints.size() - laid; i < command.prints.size(); ++i)
        add_operator(command.prints[i], command.life, change);
    if (command.keep == 0) return {};
    const auto& passing = operators.passing_prints();
    size_t many = passing.size() + (ends ? laid : 0);
    for (auto oldest = passing.begin(); many > command.keep && oldest != passing.end(); ++oldest, --many)
        change_operator(*oldest, std::nullopt, change);
    return {};
}

Status Document::Impl::complete(OperatorShape& shape) {
    auto* event = std::get_if<Event>(&shape);
    if (!event || event->kind != EventKind::landslide || event->to_m) return {};
    const auto end = run_out(*event);
    if (!end.ok()) return end.error();
    event->to_m = *end;
    return {};
}

Status Document::Impl::compute(const AddOperatorCommand& command, Change& change) {
    LOAM_TRY(known_parts(command.shape));
    LOAM_TRY(known_function(command.shape, nullptr));
    OperatorShape shape = command.shape;
    LOAM_TRY(complete(shape));
    add_operator(std::move(shape), command.life, change);
    return {};
}

Status Document::Impl::compute(const EditOperatorCommand& command, Change& change) {
    const auto op = find_operator(command.id);
    if (!op) return error("there is no operator {}", command.id);
    LOAM_TRY(known_parts(command.shape));
    LOAM_TRY(known_function(command.shape, &op->shape));
    Operator edited = *op;
    edited.shape = command.shape;
    LOAM_TRY(complete(edited.shape));
    if (command.life) edited.life = *command.life;
    if (std::holds_alternative<Event>(edited.shape)) edited.life = {};  // its parts have their own
    change_operator(command.id, std::move(edited), change);
    return {};
}

Status Document::Impl::compute(const ReorderCommand& command, Change& change) {
    const auto op = find_operator(command.id);
    if (!op) return error("there is no operator {}", command.id);
    if (op->order == command.order) return {};
    Operator moved = *op;
    moved.order = command.order;
    change_operator(command.id, std::move(moved), change);
    return {};
}

Status Document::Impl::compute(const SetOperatorCommand& command, Change& change) {
    const auto op = find_operator(command.id);
    if (!op) return error("there is no operator {}", command.id);
    if (op->enabled == command.enabled) return {};
    Operator switched = *op;
    switched.enabled = command.enabled;
    change_operator(command.id, switched, change);
    return {};
}

Status Document::Impl::compute(const RemoveOperatorCommand& command, Change& change) {
    if (!find_operator(command.id)) return error("there is no operator {}", command.id);
    change_operator(command.id, std::nullopt, change);
    return {};
}

Status Document::Impl::compute(const TransitionCommand& command, Change& change) {
    ProjectSettings after = settings;
    const auto place =
        command.remove ? remove_transition(after, command.name) : put_transition(after, command);
    if (!place.ok()) return place.error();
    const std::string text = transition_json(after.layers[*place]);
    change.images.push_back(
        {RowImage::Kind::transition, int64_t(*place), std::vector<uint8_t>(text.begin(), text.end())});
    return {};
}

// Before the commit: killed between the two, the list has a change that the journal does not know, which
// harms nothing.
Status Document::Impl::save_settings(const Change& change) {
    return change.settings ? save_project(folder, *change.settings) : Status();
}

void Document::Impl::take_back_settings(const Change& change) {
    if (!change.settings) return;
    if (const Status status = save_project(folder, settings); !status.ok())
        log(LogLevel::error, "{}", status.message());
}

Status Document::Impl::write_change(Change& change, const JournalRow& row_head, const PageBalance& before) {
    if (applied_count() < heads.size()) LOAM_TRY(store.erase_undone());
    PageBalance balance = before;
    SettingsEdit edit{settings};
    LOAM_TRY(swap_images(store, change.images, balance, edit));
    change.settings = std::move(edit.changed);
    change.dirt.layers = change.settings.has_value();
    JournalRow row = row_head;
    row.images = image_bytes(change.images);
    row.dirt = dirt_bytes(change.dirt);
    LOAM_TRY(store.write_journal(row));
    LOAM_TRY(store.write_meta("next_sequence", int64_t(row.sequence + 1)));
    if (change.next_operator != next_operator)
        LOAM_TRY(store.write_meta("next_operator", int64_t(change.next_operator)));
    if (balance.height != before.height) LOAM_TRY(store.write_meta("height_pages", balance.height));
    if (balance.index != before.index) LOAM_TRY(store.write_meta("index_pages", balance.index));
    LOAM_TRY(store.write_meta(kTimeMeta, std::bit_cast<int64_t>(operators.time_s())));
    page_count = balance;
    return {};
}

void Document::Impl::follow_heights(Dirt& dirt) const {
    std::vector<const Operator*> found;
    for (const WorldRect& rect : dirt.height) {
        operators.over_index().query(rect, found);
        for (const Operator* op : found)
            if (const auto* flood = std::get_if<Flood>(&op->shape))
                dirt.index.push_back(intersected(rect, bounds_of(*flood)));
    }
}

void Document::Impl::wake_operators(const Change& change) {
    for (const auto& [id, op] : change.operators)
        if (!operators.find(id)) nodes->wake(id);
}

void Document::Impl::show_operators(Change& change) {
    for (const auto& [id, op] : change.operators) {
        operators.add_shown(id, change.dirt);
        operators.remove(id);
        if (const Operator* before = nodes->find_loaded(id)) append_dirt(change.dirt, *before);
        nodes->remove(id);
        if (op && node_of(*op, grids)) {
            nodes->set(*op);
            append_dirt(change.dirt, *op);
        } else if (op) {
            operators.set(*op);
            operators.add_shown(id, change.dirt);
        }
        changed_operators.push_back({revision + 1, id});
    }
    while (changed_operators.size() > kMostRemembered) {
        forgotten_revision = changed_operators.front().revision;
        changed_operators.pop_front();
    }
    follow_heights(change.dirt);
}

Result<Dirt> Document::Impl::set_time(double time_s) {
    Dirt dirt;
    if (time_s != operators.time_s()) {
        const Exclusive exclusive(*this);
        operators.set_time(time_s, dirt);
        follow_heights(dirt);
    }
    merge_dirt(dirt, kMaxOperatorRects);
    return dirt;
}

Dirt Document::Impl::function_dirt(const std::vector<std::string>& names) {
    Dirt all;
    if (names.empty()) return all;
    const Exclusive exclusive(*this);
    ++revision;
    for (const Operator& op : operators.sorted()) {
        const DecalMaterial* material = material_of(op.shape);
        if (material && std::find(names.begin(), names.end(), material->function) != names.end())
            operators.add_shown(op.id, all);
    }
    for (const std::string& name : names) {
        const Status status = pages->with_store([&](PageStore& reader) {
            return reader.for_each_operator_of_function(name, [&](const PageStore::OperatorRow& row) {
                if (const auto op = parse_operator(row.id, row.json); op.ok()) append_dirt(all, *op);
                return Status();
            });
        });
        if (!status.ok())
            log(LogLevel::error, "decals of {} are not drawn again: {}", name, status.message());
    }
    merge_dirt(all, kMaxOperatorRects);
    Dirt dirt;  // what else they do does not change
    dirt.texture = std::move(all.texture);
    dirt.texture_size_m = all.texture_size_m;
    return dirt;
}

Dirt Document::poll_functions() {
    return impl_->function_dirt(impl_->functions->poll());
}

Result<Dirt> Document::Impl::commit_change(Change& change, const Command& command) {
    const JournalRow row{.sequence = next_sequence,
                         .group = command.group,
                         .applied = true,
                         .json = to_json(command),
                         .images = {},
                         .dirt = {}};
    const PageBalance before = page_count;
    LOAM_TRY(store.begin());
    Status status = write_change(change, row, before);
    if (status.ok()) status = save_settings(change);
    if (status.ok()) {
        const Exclusive exclusive(*this);
        wake_operators(change);
        status = store.commit();
        if (status.ok()) {
            if (change.settings) settings = std::move(*change.settings);
            if (change.heights) change.heights->publish(change.height_changes);
            if (change.texels) change.texels->publish(change.index_changes);
            show_operators(change);
            heads.resize(applied_count());
            heads.push_back({row.sequence, row.group, true});
            next_sequence = row.sequence + 1;
            next_operator = change.next_operator;
            next_group = std::max(next_group, row.group + 1);
            ++revision;
            merge_dirt(change.dirt, kMaxOperatorRects);
            return std::move(change.dirt);
        }
        take_back_settings(change);
    }
    store.rollback();
    page_count = before;
    return status.error();
}

Status Document::Impl::write_swaps(size_t first, size_t end, bool applied, Change& change,
                                   PageBalance& balance) {
    const size_t count = end - first;
    SettingsEdit edit{settings};
    for (size_t i = 0; i < count; ++i) {
        // Undo from the newest back, redo from the oldest on.
        auto row = store.read_journal(heads[applied ? first + i : end - 1 - i].sequence);
        if (!row.ok()) return row.error();
        auto images = images_of(row->images);
        if (!images.ok()) return images.error();
        for (const RowImage& image : *images) {
            if (image.kind == RowImage::Kind::page) {
                change.height_changes.push_back(
                    {image.key, std::nullopt});  // of either map: only the key counts here
                continue;
            }
            if (image.kind == RowImage::Kind::transition) continue;  // swap_images reads it
            auto& op = change.operators[uint64_t(image.key)];
            op.reset();
            if (!image.bytes) continue;
            auto parsed =
                parse_operator(uint64_t(image.key),
                               {reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()});
            if (!parsed.ok()) return error("the journal: {}", parsed.message());
            op = *parsed;
            if (const Status given = give_parts(*op); !given)
                log(LogLevel::warning, "operator {} shows nothing: {}", image.key, given.message());
        }
        auto dirt = dirt_of(row->dirt);
        if (!dirt.ok()) return dirt.error();
        append_dirt(change.dirt, *dirt);
        LOAM_TRY(swap_images(store, *images, balance, edit));
        row->images = image_bytes(*images);
        row->applied = applied;
        LOAM_TRY(store.write_journal(*row));
    }
    change.settings = std::move(edit.changed);
    change.dirt.layers = change.settings.has_value();
    LOAM_TRY(store.write_meta("height_pages", balance.height));
    return store.write_meta("index_pages", balance.index);
}

Result<Dirt> Document::Impl::swap_commands(size_t first, size_t end, bool applied) {
    Change change;
    PageBalance balance = page_count;
    LOAM_TRY(store.begin());
    Status status = write_swaps(first, end, applied, change, balance);
    if (status.ok()) status = save_settings(change);
    if (status.ok()) {
        const Exclusive exclusive(*this);
        wake_operators(change);
        status = store.commit();
        if (status.ok()) {
            if (change.settings) settings = std::move(*change.settings);
            for (const PageChange& page : change.height_changes) pages->forget(page.key);
            show_operators(change);
            for (size_t i = first; i < end; ++i) heads[i].applied = applied;
            page_count = balance;
            ++revision;
            merge_dirt(change.dirt, kMaxOperatorRects);
            return std::move(change.dirt);
        }
        take_back_settings(change);
    }
    store.rollback();
    return status.error();
}

// After the readers have been let in again. A failure costs nothing: the log stays and grows.
void Document::Impl::tidy_log() {
    const Status status = store.checkpoint_when_due();
    if (!status.ok()) log(LogLevel::warning, "{}", status.message());
}

Result<Dirt> Document::apply(const Command& command) {
    if (std::holds_alternative<UndoCommand>(command.body)) return undo();
    if (std::holds_alternative<RedoCommand>(command.body)) return redo();
    LOAM_TRY(check_command(command));
    if (const auto* time = std::get_if<TimeCommand>(&command.body)) return impl_->set_time(time->time_s);
    LOAM_TRY(impl_->may_write());
    if (const auto* function = std::get_if<FunctionCommand>(&command.body)) {
        LOAM_TRY(impl_->functions->set(function->name, function->text));
        return impl_->function_dirt({function->name});
    }
    Impl::Change change;
    change.next_operator = impl_->next_operator;
    LOAM_TRY(std::visit([&](const auto& body) { return impl_->compute(body, change); }, command.body));
    // A part of a large fill may find nothing to do: that is no step to undo.
    if (std::holds_alternative<FillCommand>(command.body) && change.images.empty()) return Dirt{};
    merge_dirt(change.dirt, kMaxOperatorRects);
    auto dirt = impl_->commit_change(change, command);
    impl_->tidy_log();
    return dirt;
}

Result<Dirt> Document::undo() {
    LOAM_TRY(impl_->may_write());
    const auto& heads = impl_->heads;
    const size_t end = impl_->applied_count();
    if (end == 0) return error("nothing to undo");
    size_t first = end - 1;
    while (first > 0 && heads[first].group != 0 && heads[first - 1].group == heads[first].group) --first;
    auto dirt = impl_->swap_commands(first, end, false);
    impl_->tidy_log();
    return dirt;
}

Result<Dirt> Document::redo() {
    LOAM_TRY(impl_->may_write());
    const auto& heads = impl_->heads;
    const size_t first = impl_->applied_count();
    if (first == heads.size()) return error("nothing to redo");
    size_t end = first + 1;
    while (end < heads.size() && heads[first].group != 0 && heads[end].group == heads[first].group) ++end;
    auto dirt = impl_->swap_commands(first, end, true);
    impl_->tidy_log();
    return dirt;
}

}  // namespace loam
