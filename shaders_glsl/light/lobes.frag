#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// CELLS: surfaces that rays meet have light.
// Variant: CELLS
#include "lobes.glsl"

layout(location = 0) out vec4 light; // rgb: kcd/m^2; a: number of the material plus 1, or 0 where there is no lobe

void main() {
    light = in_lobes(gl_FragCoord.xy);
}
