// One triangle over everything, at the depth of the push constant.
#version 460

layout(push_constant) uniform Params {
    vec4 color;
    float depth;
} params;

void main() {
    const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, params.depth, 1.0);
}
