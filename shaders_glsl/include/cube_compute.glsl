// Texel addressing for compute shaders that write a cube, for devices without geometry shaders.

layout(local_size_x = 8, local_size_y = 8) in;

/// Column, row and face.
ivec3 cube_texel() {
    return ivec3(gl_GlobalInvocationID);
}

/// Whether the texel lies within a face of this size: workgroups may extend beyond it.
bool is_texel_of(ivec2 size) {
    return all(lessThan(cube_texel().xy, size));
}

/// Unit direction through the texel's centre.
vec3 texel_direction(ivec2 size) {
    vec2 st = (vec2(cube_texel().xy) + 0.5) / vec2(size);
    return normalize(cube_direction(cube_texel().z, st));
}
