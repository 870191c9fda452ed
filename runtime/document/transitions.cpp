#include "runtime/document/transitions.h"

#include <algorithm>

#include "runtime/document/brush_step.h"

namespace loam {

namespace {

constexpr int kReach = 2;  // a changed texel changes what its neighbours want, and that what theirs take
constexpr int kNone = -1;

// A square of the map and what is around it; outside the map the nearest texel inside.
struct Window {
    int x0, y0, width, height;
    [[nodiscard]] size_t at(int x, int y) const { return size_t(y - y0) * size_t(width) + size_t(x - x0); }
};

Window around(const TexelRect& rect, int by) {
    return {rect.x0 - by, rect.y0 - by, rect.width() + 2 * by, rect.height() + 2 * by};
}

// Which transition a texel wants, by its place in the list.
int wanted(const std::vector<Transition>& transitions, const std::vector<uint16_t>& plain, const Window& w,
           int x, int y) {
    const uint16_t own = plain[w.at(x, y)];
    int other = kNone;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const uint16_t layer = plain[w.at(x + i, y + j)];
            if (layer == own || layer == other) continue;
            if (other != kNone) return kNone;
            other = layer;
        }
    if (other == kNone) return kNone;
    for (size_t k = 0; k < transitions.size(); ++k)
        if (transitions[k].placed && transitions[k].from == own && transitions[k].to == other) return int(k);
    return kNone;
}

LayerEntry* find_layer(ProjectSettings& settings, const std::string& name) {
    const auto found = std::find_if(settings.layers.begin(), settings.layers.end(),
                                    [&](const LayerEntry& l) { return l.name == name; });
    return found == settings.layers.end() ? nullptr : &*found;
}

}  // namespace

Result<size_t> put_transition(ProjectSettings& settings, const TransitionCommand& command) {
    LayerEntry* entry = find_layer(settings, command.name);
    if (entry && (!entry->blend || entry->blend->removed))
        return error("\"{}\" is {}, not a transition", command.name,
                     entry->blend ? "a removed one" : "a layer");
    if (!entry) {
        if (command.from.empty() || command.to.empty())
            return error("there is no transition \"{}\"; a new one needs the layers it is from and to",
                         command.name);
        const auto removed = std::find_if(settings.layers.begin(), settings.layers.end(),
                                          [](const LayerEntry& l) { return l.blend && l.blend->removed; });
        entry = removed != settings.layers.end() ? &*removed : &settings.layers.emplace_back();
        entry->name = command.name;
        entry->blend = LayerEntry::Blend{};
    }
    if (!command.from.empty()) entry->blend->from = command.from;
    if (!command.to.empty()) entry->blend->to = command.to;
    if (command.threshold) entry->blend->threshold = *command.threshold;
    const size_t place = size_t(entry - settings.layers.data());
    LOAM_TRY(check_settings(settings));
    return place;
}

Result<size_t> remove_transition(ProjectSettings& settings, const std::string& name) {
    LayerEntry* entry = find_layer(settings, name);
    if (!entry || !entry->blend || entry->blend->removed) return error("there is no transition \"{}\"", name);
    entry->blend->removed = true;
    const size_t place = size_t(entry - settings.layers.data());
    entry->name = name_of_removed(settings, place);
    return place;
}

std::string name_of_removed(const ProjectSettings& settings, size_t place) {
    std::string name = fmt::format("removed transition {}", place);
    for (size_t i = 0; i < settings.layers.size(); ++i)
        if (i != place && settings.layers[i].name == name) name += " ", i = size_t(-1);
    return name;
}

std::vector<Transition> transitions_of(const ProjectSettings& settings) {
    const auto number_of = [&](const std::string& name) {
        const auto found = std::find_if(settings.layers.begin(), settings.layers.end(),
                                        [&](const LayerEntry& l) { return l.name == name; });
        return uint16_t(found - settings.layers.begin());
    };
    std::vector<Transition> transitions;
    for (size_t i = 0; i < settings.layers.size(); ++i) {
        const auto& blend = settings.layers[i].blend;
        if (!blend) continue;
        const uint16_t from = number_of(blend->from), to = number_of(blend->to);
        const bool shows_to = blend->removed && blend->threshold >= 0.5;
        transitions.push_back({uint16_t(i), shows_to ? to : from, shows_to ? from : to, !blend->removed});
    }
    return transitions;
}

Status place_transitions(const std::vector<Transition>& transitions, const TexelRect& changed,
                         PageEdits<IndexTexel>& edits) {
    if (transitions.empty() || changed.empty()) return {};
    const MapShape& shape = edits.shape();
    const TexelRect solved = intersected(
        TexelRect{changed.x0 - kReach, changed.y0 - kReach, changed.x1 + kReach, changed.y1 + kReach},
        TexelRect{0, 0, shape.samples_x, shape.samples_y});
    const Window seen = around(solved, 2), wishing = around(solved, 1);
    std::vector<IndexTexel> texels(size_t(seen.width) * size_t(seen.height));
    LOAM_TRY(edits.read(seen.x0, seen.y0, seen.width, seen.height, texels.data()));
    std::vector<uint16_t> plain(texels.size());
    for (size_t i = 0; i < texels.size(); ++i) {
        plain[i] = texels[i].layer;
        for (const Transition& t : transitions)
            if (t.layer == texels[i].layer) plain[i] = t.from;
    }
    std::vector<int> wishes(size_t(wishing.width) * size_t(wishing.height));
    for (int y = wishing.y0; y < wishing.y0 + wishing.height; ++y)
        for (int x = wishing.x0; x < wishing.x0 + wishing.width; ++x)
            wishes[wishing.at(x, y)] = wanted(transitions, plain, seen, x, y);

    return for_each_page_under(solved, [&](int page_x, int page_y, const TexelRect& part) -> Status {
        const auto page = edits.page(page_x, page_y);
        if (!page.ok()) return page.error();
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const int wish = wishes[wishing.at(x, y)];
                bool taken = wish != kNone;
                for (int j = -1; taken && j <= 1; ++j)
                    for (int i = -1; i <= 1; ++i) {
                        const int other = wishes[wishing.at(x + i, y + j)];
                        taken &= other == kNone || other == wish;
                    }
                (*page)[(y - page_y * kBasePageSide) * kBasePageSide + x - page_x * kBasePageSide].layer =
                    taken ? transitions[size_t(wish)].layer : plain[seen.at(x, y)];
            }
        return {};
    });
}

}  // namespace loam
