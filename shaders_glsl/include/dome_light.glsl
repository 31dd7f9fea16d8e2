// The light of the dome's directions. Needs dome.glsl, colour.glsl, constants.glsl, DIRECTIONS and `is_reached`.

/// The light of this frame's directions on a face; rgb: with V; a: its luminance without V. Without V the ground's part has a
/// closed form and needs no sampling. `ground`: radiance below the horizon, kcd/m^2.
vec4 light_of_directions(vec3 world, vec3 n, vec3 face, vec3 ground) {
    vec3 visible = vec3(0.0);
    float whole = luminance(ground) * (0.5 * PI * (1.0 - n.y));
    for (int k = 0; k < DIRECTIONS; ++k) {
        float cosine = dot(n, dome.toward[k].xyz);
        if (cosine <= 0.0) continue;
        vec3 light = dome.light[k].rgb * cosine;
        whole += luminance(light) * dome.light[k].a;
        if (is_reached(k, world, n, face)) visible += light;
    }
    return vec4(visible, whole);
}
