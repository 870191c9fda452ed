// What the two encoders read: a texel of mip kMip of a rectangle in scratch; mip 1 is the mean of four texels.
layout(constant_id = 0) const int kMip = 0;
layout(binding = 0) uniform sampler2D scratch;
layout(push_constant, scalar) uniform Push { EncodePush push; };

vec3 read_texel(ivec2 texel) {
    if (kMip == 0) return texelFetch(scratch, push.scratch_min + texel, 0).rgb;
    ivec2 at = push.scratch_min + texel * 2;
    precise vec3 a = texelFetch(scratch, at, 0).rgb;
    precise vec3 b = texelFetch(scratch, at + ivec2(1, 0), 0).rgb;
    precise vec3 c = texelFetch(scratch, at + ivec2(0, 1), 0).rgb;
    precise vec3 d = texelFetch(scratch, at + ivec2(1, 1), 0).rgb;
    precise vec3 mean = (a + b + c + d) * 0.25;
    precise vec3 mean_square = sqrt((a * a + b * b + c * c + d * d) * 0.25);
    return push.albedo != 0u ? mean_square : mean; // a rectangle of a page: no branch worth having
}
