#version 460

// A star's share in a pixel: bilinear by its place, so that the shares of its 2 x 2 pixels sum to 1 wherever it stands between them.

layout(location = 0) flat in vec2 place;
layout(location = 1) flat in vec3 radiance;

layout(location = 0) out vec4 added; // kcd/m^2; nothing to the alpha

void main() {
    vec2 share = max(1.0 - abs(gl_FragCoord.xy - place), 0.0);
    added = vec4(radiance * share.x * share.y, 0.0);
}
