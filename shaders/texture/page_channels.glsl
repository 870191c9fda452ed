// The map's optional channels in a shader: by name, or by place in scratch and pages (page_format.h).
// Specialisation constant 31: the placement word; 0: none, and nothing is evaluated.
#ifndef LOAM_TEXTURE_PAGE_CHANNELS_GLSL
#define LOAM_TEXTURE_PAGE_CHANNELS_GLSL
#include "shaders/texture/page_format.h"

layout(constant_id = 31) const uint kPageChannels = 0u;
const bool kHasChannels = kPageChannels != 0u;

float channel_at(vec4 places, uint channel) {
    uint place = page_channel_place(kPageChannels, channel);
    return place == 0u ? 0.0 : places[place - 1u];
}

// What a map holds is carried by place. x scattering, y thermal, z emissive, w glint from the four places:
vec4 channels_from(vec4 places) {
    return vec4(channel_at(places, kChannelScattering), channel_at(places, kChannelThermal),
                channel_at(places, kChannelEmissive), channel_at(places, kChannelGlint));
}

// The other way, all channels in the order of kChannel…; places that no channel has are 0.
vec4 channel_places(float channels[kChannelCount]) {
    vec4 places = vec4(0);
    for (uint c = 0u; c < kChannelCount; ++c) {
        uint place = page_channel_place(kPageChannels, c);
        if (place != 0u) places[place - 1u] = channels[c];
    }
    return places;
}
#endif
