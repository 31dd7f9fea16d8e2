#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "colour.glsl"

// The colour of a cell where no surface is before it.

layout(constant_id = 0) const bool LINEAR = false; // display values are linear, else encoded

layout(set = 0, binding = 1) uniform sampler2D depth; // of the surfaces, reversed

layout(location = 0) flat in vec3 colour;

layout(location = 0) out vec4 picture;

/// How much nearer a surface must be to hide a cell: what lies in its plane does not.
const float NEARER = 1.001;

void main() {
    if (texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > NEARER * gl_FragCoord.z) discard;
    picture = vec4(LINEAR ? colour : srgb_from_linear(colour), 1.0);
}
