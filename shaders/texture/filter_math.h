// How a pixel's ellipse on the ground (shaders/geometry/pixel_ellipse_math.h) is filtered: which texel size it wants and where its
// taps lie. Sampling, feedback and the classes of screen tiles share this.
//
// A filter of N taps wants the short axis, but no finer than a taps' share of the long one (as hardware anisotropy does). Filters
// of one tap want a texel between the axes (the talk's mipBias).
// T taps lie evenly along the long axis. Their spacing gives them the variance that the ellipse has beyond one texel's, so that a
// pixel looks the same with more taps than it needs: which class its tile is in cannot be seen.
#ifndef LOAM_FILTER_MATH_H
#define LOAM_FILTER_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kMaxTaps 8
#define kTapClasses 4     // of 1, 2, 4 and 8 taps
#define kProbeTaps 4      // at most so many in one page
#define kTileSide_px 8

// A probe is one look-up of a page, and its taps stay in that page. Why four taps do, with their spacing
// limited to kTapReach: the outermost lies 1.5 spacings from the probe, 3 texels of the page's first mip at
// most, and a bilinear sample reads half a texel further: 0.5 in the first mip, 1 in the second (in the
// first's texels). 3 + 1 = 4 = kPageBorder, and the border of the second mip is as wide. (A little less than
// 2, so that rounding of coordinates cannot read the next page's first texel.) A texel wanted is below two of
// the page's first mip, as no page finer than wanted is shown, and the spacing is never above it: the limit
// binds only where the coarsest page there is is too fine.
#ifndef kTapReach // tests widen it, to see the seams
#define kTapReach 1.98f
#endif

// Log2 of the texel wanted, metres. A filter of N taps: short_share 1, log2_taps log2 N; of one: short_share between, log2_taps
// large. What is not a number stays one.
LOAM_INLINE float filter_log2_texel(float log2_long, float log2_short, float short_share, float log2_taps) {
    float between = log2_long + (log2_short - log2_long) * short_share;
    float least = log2_long - log2_taps;
    return between < least ? least : between;
}

// Which class of taps covers the ratio of the long axis to the texel: 2^class. The first goes to 1.25: what a single tap loses
// there is less than what trilinear filters lose everywhere else.
LOAM_INLINE int filter_class(float log2_ratio) {
    return log2_ratio > 2.0f ? 3 : log2_ratio > 1.0f ? 2 : log2_ratio > 0.32f ? 1 : 0;
}

// Metres between taps: T taps this far apart have the variance (long² - texel²) / 12.
LOAM_INLINE float filter_spacing_m(float log2_long, float log2_texel, int taps) {
    float long_m = exp2(log2_long), texel_m = exp2(log2_texel);
    return sqrt(max(long_m * long_m - texel_m * texel_m, 0.0f) / float(max(taps * taps - 1, 1)));
}

LOAM_END_SHARED
#endif
