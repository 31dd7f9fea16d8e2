// Pixel addressing for compute shaders that write the pixels of a picture: what a full-screen triangle does for fragment shaders.

layout(local_size_x = 8, local_size_y = 8) in;

// Storage images have their format in the shader: pictures of 32-bit floats and others are variants.
#ifdef FLOAT
#define PICTURE_FORMAT rgba32f
#else
#define PICTURE_FORMAT rgba16f
#endif

/// Column and row.
ivec2 own_pixel() {
    return ivec2(gl_GlobalInvocationID.xy);
}

/// Where storage images, which are arrays of one layer, have the pixel.
ivec3 own_texel() {
    return ivec3(own_pixel(), 0);
}

/// The pixel's centre, as gl_FragCoord has it.
vec2 pixel_centre() {
    return vec2(gl_GlobalInvocationID.xy) + 0.5;
}

/// Whether the pixel is within a picture of this size: workgroups may extend beyond it.
bool is_pixel_of(ivec2 size) {
    return all(lessThan(own_pixel(), size));
}
