#include "runtime/document/operator_set.h"

#include <algorithm>
#include <cmath>

#include "runtime/document/dirt.h"

namespace loam {

struct OperatorSet::Shown {
    const Operator* source = nullptr;
    std::unique_ptr<Operator> altered;  // where the state is not the source's own
    bool there = false;
    Moments::iterator since, until;
    bool has_since = false, has_until = false;

    [[nodiscard]] const Operator* op() const { return !there ? nullptr : altered ? altered.get() : source; }
};

struct OperatorSet::Held {
    Operator op;
    std::vector<Operator> parts;
    std::vector<Shown> shown;  // empty: shown as it is, at any time
};

namespace {

bool looks_at_ground(const Operator& op) {
    return std::holds_alternative<VolumeDecal>(op.shape) || std::holds_alternative<Flood>(op.shape);
}

// From one state to the next. A crater that only cooled has the ground it had.
void add_change(const Operator* before, const Operator* after, bool shows_heat, Dirt& dirt) {
    const Crater* crater = before && after ? std::get_if<Crater>(&before->shape) : nullptr;
    if (crater) {
        const Crater& now = std::get<Crater>(after->shape);
        if (crater->depth_m == now.depth_m && crater->age == now.age && crater->strength == now.strength) {
            if (!after->enabled || !shows_heat) return;
            const std::vector<WorldRect> rects = after->texture_rects();
            dirt.texture.insert(dirt.texture.end(), rects.begin(), rects.end());
            dirt.texture_size_m = std::max(dirt.texture_size_m, after->texture_size_m());
            return;
        }
    }
    if (before) append_dirt(dirt, *before);
    if (after) append_dirt(dirt, *after);
}

}  // namespace

OperatorSet::OperatorSet() = default;
OperatorSet::~OperatorSet() = default;

void OperatorSet::index(const Operator& op) {
    for (const WorldRect& rect : op.height_rects()) height_.add(&op, rect);
    for (const WorldRect& rect : op.index_rects()) index_.add(&op, rect);
    for (const WorldRect& rect : op.texture_rects()) texture_.add(&op, rect);
    for (const WorldRect& rect : op.cutout_rects()) cutout_.add(&op, rect);
    if (looks_at_ground(op)) ground_.add(&op, op.texture_bounds());
}

void OperatorSet::unindex(const Operator& op) {
    for (const WorldRect& rect : op.height_rects()) height_.remove(&op, rect);
    for (const WorldRect& rect : op.index_rects()) index_.remove(&op, rect);
    for (const WorldRect& rect : op.texture_rects()) texture_.remove(&op, rect);
    for (const WorldRect& rect : op.cutout_rects()) cutout_.remove(&op, rect);
    if (looks_at_ground(op)) ground_.remove(&op, op.texture_bounds());
}

void OperatorSet::show(Shown& shown) {
    const LifeState state = state_at(shown.source->life, time_s_);
    shown.there = state.there;
    shown.altered = nullptr;
    if (state.there && (state.strength != 1 || state.heat != 1 || state.age != 0)) {
        shown.altered = std::make_unique<Operator>(*shown.source);
        shown.altered->shape = shape_in(shown.source->shape, state);
    }
    shown.has_since = std::isfinite(state.since_s);
    shown.has_until = std::isfinite(state.until_s);
    if (shown.has_since) shown.since = by_since_.emplace(state.since_s, &shown);
    if (shown.has_until) shown.until = by_until_.emplace(state.until_s, &shown);
    if (const Operator* op = shown.op()) index(*op);
}

void OperatorSet::hide(Shown& shown) {
    if (const Operator* op = shown.op()) unindex(*op);
    if (shown.has_since) by_since_.erase(shown.since);
    if (shown.has_until) by_until_.erase(shown.until);
    shown.has_since = shown.has_until = shown.there = false;
}

void OperatorSet::set(const Operator& op) {
    remove(op.id);
    auto held = std::make_unique<Held>();
    held->op = op;
    if (std::holds_alternative<Event>(op.shape)) held->parts = parts_of(op);
    if (!held->parts.empty())
        held->shown.resize(held->parts.size());
    else if (!op.life.ever())
        held->shown.resize(1);
    for (size_t i = 0; i < held->shown.size(); ++i) {
        held->shown[i].source = held->parts.empty() ? &held->op : &held->parts[i];
        show(held->shown[i]);
    }
    if (held->shown.empty()) index(held->op);
    if (std::holds_alternative<Footprint>(op.shape) && op.life.until_s < Life::kEver_s)
        passing_prints_.insert(op.id);
    by_id_.emplace(op.id, std::move(held));
}

void OperatorSet::remove(uint64_t id) {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return;
    Held& held = *found->second;
    for (Shown& shown : held.shown) hide(shown);
    if (held.shown.empty()) unindex(held.op);
    passing_prints_.erase(id);
    by_id_.erase(found);
}

void OperatorSet::set_time(double time_s, Dirt& dirt) {
    std::vector<Shown*> changed;
    if (time_s > time_s_)
        for (auto it = by_until_.begin(); it != by_until_.end() && it->first <= time_s; ++it)
            changed.push_back(it->second);
    else
        for (auto it = by_since_.upper_bound(time_s); it != by_since_.end(); ++it)
            changed.push_back(it->second);
    time_s_ = time_s;
    // In order of evaluation, which is by place where an event has many parts.
    std::sort(changed.begin(), changed.end(),
              [](const Shown* a, const Shown* b) { return evaluated_before(*a->source, *b->source); });
    for (Shown* shown : changed) {
        std::unique_ptr<Operator> before;
        if (const Operator* op = shown->op()) before = std::make_unique<Operator>(*op);
        hide(*shown);
        show(*shown);
        add_change(before.get(), shown->op(), shows_heat_, dirt);
    }
}

void OperatorSet::add_shown(uint64_t id, Dirt& dirt) const {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return;
    const Held& held = *found->second;
    for (const Shown& shown : held.shown)
        if (const Operator* op = shown.op()) append_dirt(dirt, *op);
    if (held.shown.empty()) append_dirt(dirt, held.op);
}

const Operator* OperatorSet::find(uint64_t id) const {
    const auto found = by_id_.find(id);
    return found == by_id_.end() ? nullptr : &found->second->op;
}

OperatorSet::Cost OperatorSet::cost_of(uint64_t id) const {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return {};
    const Held& held = *found->second;
    Cost cost{held.parts.size(), sizeof(Held)};
    cost.bytes += held.parts.capacity() * sizeof(Operator) + held.shown.capacity() * sizeof(Shown);
    for (const Shown& shown : held.shown) cost.bytes += shown.altered ? sizeof(Operator) : 0;
    return cost;
}

namespace {

std::vector<Operator> copies_in_order(std::vector<const Operator*> order) {
    std::sort(order.begin(), order.end(),
              [](const Operator* a, const Operator* b) { return evaluated_before(*a, *b); });
    std::vector<Operator> all;
    all.reserve(order.size());
    for (const Operator* op : order) all.push_back(*op);
    return all;
}

}  // namespace

std::vector<Operator> OperatorSet::sorted() const {
    std::vector<const Operator*> all;
    all.reserve(by_id_.size());
    for (const auto& [id, held] : by_id_) all.push_back(&held->op);
    return copies_in_order(std::move(all));
}

std::vector<Operator> OperatorSet::timed() const {
    std::vector<const Operator*> timed;
    for (const auto& [id, held] : by_id_)
        if (!held->shown.empty() || std::holds_alternative<Event>(held->op.shape)) timed.push_back(&held->op);
    return copies_in_order(std::move(timed));
}

}  // namespace loam
