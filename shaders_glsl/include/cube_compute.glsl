// A texel of a cube that is written by a compute shader, on devices without geometry shaders.

layout(local_size_x = 8, local_size_y = 8) in;

/// Column, row and face.
ivec3 cube_texel() {
    return ivec3(gl_GlobalInvocationID);
}

/// Whether the texel is one of a cube with faces of this size: groups may reach beyond.
bool is_texel_of(ivec2 size) {
    return all(lessThan(cube_texel().xy, size));
}

/// Direction through the centre of the texel, unit.
vec3 texel_direction(ivec2 size) {
    vec2 st = (vec2(cube_texel().xy) + 0.5) / vec2(size);
    return normalize(cube_direction(cube_texel().z, st));
}
