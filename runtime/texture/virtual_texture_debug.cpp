// What debug views see of the texture. Nothing here runs for a picture without one.
#include <algorithm>

#include "runtime/document/document.h"
#include "runtime/texture/decals.h"
#include "runtime/texture/virtual_texture_impl.h"

namespace loam {

namespace {

uint32_t state_of(PagePool::State state) {
    switch (state) {
        case PagePool::State::free:
            return kPlaceFree;
        case PagePool::State::composed:
            return kPlaceComposed;
        case PagePool::State::usable:
            return kPlaceUsable;
        case PagePool::State::resting:
            return kPlaceResting;
    }
    return kPlaceFree;
}

}  // namespace

std::vector<shared::VtPlaceFacts> VirtualTexture::place_facts(DecalCount decals) const {
    const Impl& t = *impl_;
    const auto lock = t.document.read_lock();
    std::vector<shared::VtPlaceFacts> facts(size_t(t.pool.place_count()));
    for (int i = 0; i < t.pool.place_count(); ++i) {
        const PagePool::Place& p = t.pool.place(i);
        shared::VtPlaceFacts& f = facts[size_t(i)];
        f.state = state_of(p.state);
        if (p.state == PagePool::State::free) continue;
        f.age = uint32_t(t.frame - std::min(t.frame, p.last_requested));
        f.popularity = t.popularity[size_t(i)];
        f.dirt = t.facts.dirt(i, p, t.frame);
        f.cost = t.facts.cost_pages(i, t.frame);
        if (decals == DecalCount::none) continue;
        DecalList list;
        add_decals(t.document, t.layers, LayerTier::whole, t.layout, p.page, {0, 0, kPageTexels, kPageTexels},
                   {0, 0}, list);
        f.decals = uint32_t(list.marks.size() + list.paints.size());
    }
    return facts;
}

std::vector<shared::VtImageSquare> VirtualTexture::image_squares() const {
    const Impl& t = *impl_;
    std::vector<shared::VtImageSquare> squares = {{0, 0, 1 << t.layout.default_log2_width, 0}};
    for (const LiveSector& s : t.sectors.live())
        squares.push_back({s.origin.x, s.origin.y, 1 << s.log2_width(), uint32_t(s.id)});
    return squares;
}

}  // namespace loam
