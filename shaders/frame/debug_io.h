// Debug views: their numbers, what they know of every place of the physical texture, and their colours, which the
// legends in the window show too. Source: Call of Duty talk, "Indirection Texture In Action".
#ifndef LOAM_FRAME_DEBUG_IO_H
#define LOAM_FRAME_DEBUG_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// DebugView (runtime/frame/frame_settings.h)
#define kDebugMips 1u
#define kDebugSectors 2u
#define kDebugNormals 3u
#define kDebugOcclusion 4u
#define kDebugIndirection 5u
#define kDebugShadow 6u
#define kDebugAlbedo 7u
#define kDebugWanted 8u
#define kDebugCoarser 9u
#define kDebugAge 10u
#define kDebugRequests 11u
#define kDebugDirt 12u
#define kDebugCost 13u
#define kDebugDecals 14u
#define kDebugHeights 15u
#define kDebugAtlas 16u
#define kDebugIndirectionMap 17u
#define kDebugThermal 18u

#define kDebugFactsSlot 20   // VtPlaceFacts, one a place
#define kDebugSquaresSlot 21 // VtImageSquare, ended by one without a size

#define kPlaceFree 0u
#define kPlaceComposed 1u
#define kPlaceUsable 2u
#define kPlaceResting 3u

struct VtPlaceFacts {
    uint state;       // kPlaceFree …
    uint age;         // frames since the page was last requested
    uint popularity;  // cells of the feedback that want it or something below it; 0: not wanted
    float dirt;       // 1 dirty now, else falling to 0 since the last edit
    float cost;       // texels composed in it lately, in whole pages
    uint decals;      // over the page
};

// A virtual image in the indirection texture.
struct VtImageSquare {
    int x, y, size; // texels
    uint id;        // sector id
};

#define kDebugStepCount 12
// Distinct colours for small numbers: mips, levels.
LOAM_INLINE vec3 debug_step_color(int step) {
    step = step < 0 ? 0 : step;
    step = step % kDebugStepCount;
    if (step == 0) return vec3(0.95f, 0.95f, 0.95f);
    if (step == 1) return vec3(0.35f, 0.80f, 0.35f);
    if (step == 2) return vec3(0.30f, 0.55f, 0.95f);
    if (step == 3) return vec3(0.75f, 0.40f, 0.90f);
    if (step == 4) return vec3(0.25f, 0.85f, 0.85f);
    if (step == 5) return vec3(0.95f, 0.80f, 0.25f);
    if (step == 6) return vec3(0.95f, 0.50f, 0.20f);
    if (step == 7) return vec3(0.90f, 0.25f, 0.25f);
    if (step == 8) return vec3(0.60f, 0.40f, 0.25f);
    if (step == 9) return vec3(0.95f, 0.55f, 0.75f);
    if (step == 10) return vec3(0.55f, 0.65f, 0.25f);
    return vec3(0.45f, 0.45f, 0.50f);
}

// Quantities: 0 blue, through green and yellow, 1 red.
LOAM_INLINE vec3 debug_ramp_color(float share) {
    float t = clamp(share, 0.0f, 1.0f);
    return vec3(clamp(3.0f * t - 1.0f, 0.05f, 0.95f), clamp(2.0f - abs(4.0f * t - 2.0f) * 0.9f, 0.15f, 0.85f),
                clamp(1.4f - 3.0f * t, 0.05f, 0.95f));
}
// Logarithmic: 0 at 0, 1 at `most` and above.
LOAM_INLINE float debug_log_share(float value, float most) { return log2(1.0f + value) / log2(1.0f + most); }

#define kDebugMostFrames 255.0f   // of ages
#define kDebugMostCells 65535.0f  // of requests
#define kDebugMostPages 16.0f     // of composition cost
#define kDebugMostDecals 63.0f
#define kDebugUnwanted vec3(0.35f, 0.35f, 0.38f) // pages that nobody asks for

LOAM_END_SHARED
#endif
