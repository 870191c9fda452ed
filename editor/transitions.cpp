#include "editor/transitions.h"

#include <algorithm>

namespace loam {

namespace {

LayerEntry* find(ProjectSettings& settings, const std::string& name) {
    const auto found = std::find_if(settings.layers.begin(), settings.layers.end(),
                                    [&](const LayerEntry& l) { return l.name == name; });
    return found == settings.layers.end() ? nullptr : &*found;
}

}  // namespace

Status put_transition(ProjectSettings& settings, const TransitionRequest& request) {
    LayerEntry* entry = find(settings, request.name);
    if (entry && (!entry->blend || entry->blend->removed))
        return error("\"{}\" is {}, not a transition", request.name,
                     entry->blend ? "a removed one" : "a layer");
    if (!entry) {
        if (request.from.empty() || request.to.empty())
            return error("there is no transition \"{}\"; a new one needs the layers it is from and to",
                         request.name);
        const auto removed = std::find_if(settings.layers.begin(), settings.layers.end(),
                                          [](const LayerEntry& l) { return l.blend && l.blend->removed; });
        entry = removed != settings.layers.end() ? &*removed : &settings.layers.emplace_back();
        entry->name = request.name;
        entry->blend = LayerEntry::Blend{};
    }
    if (!request.from.empty()) entry->blend->from = request.from;
    if (!request.to.empty()) entry->blend->to = request.to;
    if (request.threshold) entry->blend->threshold = *request.threshold;
    return check_settings(settings);
}

Status remove_transition(ProjectSettings& settings, const std::string& name) {
    LayerEntry* entry = find(settings, name);
    if (!entry || !entry->blend || entry->blend->removed) return error("there is no transition \"{}\"", name);
    entry->blend->removed = true;
    int number = 1;
    const auto free_name = [&] { return fmt::format("removed transition {}", number); };
    while (find(settings, free_name())) ++number;
    entry->name = free_name();
    return {};
}

}  // namespace loam
